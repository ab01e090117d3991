#include "familiar_names.hpp"

#include <algorithm>
#include <utility>

namespace skein::command {
namespace {

const FamiliarName kNames[] = {
    {"bw", "rate"},
    {"hz", "rate"},
    {"bag", "info"},
    {"bag info", "info"},
    {"bag play", "replay"},
    {"bag record", "record"},
    {"interface", "describe"},
    {"list", "services"},
    {"node", "peers"},
    {"param describe", "param list"},
    {"param dump", "param list"},
    {"parameter", "param list"},
    {"play", "replay"},
    {"nodes", "peers"},
    {"ps", "peers"},
    {"pub", "publish"},
    {"rqt_graph", "graph"},
    {"run", "launch"},
    {"service", "services"},
    {"service call", "call"},
    {"service type", "describe"},
    {"show", "describe"},
    {"start", "launch"},
    {"sub", "echo"},
    {"topic", "topics"},
    {"topic bw", "rate"},
    {"topic echo", "echo"},
    {"topic hz", "rate"},
    {"topic info", "topics"},
    {"topic pub", "publish"},
    {"topic type", "describe"},
    {"validate", "check"},
    {"wtf", "doctor"},
};

const std::pair<const char*, const char*> kOptions[] = {
    {"-d", "--domain"}, {"-n", "--count"}, {"-o", "--output"}, {"-p", "--profile"},
    {"-r", "--rate"},   {"-s", "--split"}, {"-t", "--topics"}, {"-w", "--wait"},
};

}  // namespace

std::string familiar_option(const std::string& theirs) {
  const auto found =
      std::ranges::find(kOptions, theirs, [](const auto& each) { return each.first; });
  return found == std::end(kOptions) ? "" : found->second;
}

std::span<const FamiliarName> familiar_names() { return kNames; }

std::string familiar_name(const std::vector<std::string>& words) {
  for (std::size_t count = std::min<std::size_t>(words.size(), 2); count > 0; --count) {
    const std::string theirs = count == 2 ? words[0] + " " + words[1] : words[0];
    const auto found = std::ranges::find(kNames, theirs, &FamiliarName::theirs);
    if (found != std::end(kNames)) return found->ours;
  }
  return {};
}

}  // namespace skein::command
