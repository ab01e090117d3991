#include "selection/description.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>

#include "selection/words.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks::selection {
namespace {

class DescriptionReader {
 public:
  explicit DescriptionReader(const std::filesystem::path& file) : file_(file) {
    std::ifstream stream(file);
    if (!stream) throw InvalidArgument(file.string() + " cannot be read; name an ASlib folder");
    try {
      root_ = YAML::Load(with_quoted_marks(stream));
    } catch (const YAML::Exception& error) {
      refuse(error.mark, "it is no YAML: " + error.msg, "correct it");
    }
    if (!root_.IsMap())
      refuse(root_.Mark(), "it has no keys", "write `scenario_id: NAME` and so on");
  }

  Description read() const {
    Description found;
    found.id = list("scenario_id").empty() ? file_.parent_path().filename().string()
                                           : list("scenario_id").front();
    found.runtime = runtime();
    found.cutoff_s = cutoff_s();
    found.algorithms = algorithms();
    read_steps(found);
    found.default_steps = list("default_steps");
    leave_out_algorithm_steps(found);
    check_steps(found);
    return found;
  }

 private:
  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& cause,
                           const std::string& remedy) const {
    const std::string line = mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
    throw InvalidArgument(file_.string() + line + ": " + cause + "; " + remedy);
  }

  /// Published scenarios write `key: ?` for what is not known, which in YAML begins a key.
  static std::string with_quoted_marks(std::istream& stream) {
    std::string text;
    for (std::string line; std::getline(stream, line);) {
      std::string before = trimmed(line);
      bool unknown = before.ends_with('?');
      if (unknown) before = trimmed(before.substr(0, before.size() - 1));
      unknown = unknown && (before.ends_with(':') || before == "-");
      text += unknown ? line.substr(0, line.rfind('?')) + "'?'" : line;
      text += '\n';
    }
    return text;
  }

  YAML::Node node(const std::string& key) const {
    const YAML::Node found = root_[key];
    return found ? found : YAML::Node();
  }
  YAML::Mark mark(const std::string& key) const {
    const YAML::Node found = node(key);
    return found.IsDefined() && !found.IsNull() ? found.Mark() : YAML::Mark::null_mark();
  }

  /// A list, or a scalar with commas; empty for `?`, an empty text and null.
  static std::vector<std::string> list(const YAML::Node& node) {
    std::vector<std::string> found;
    if (!node.IsDefined() || node.IsNull()) return found;
    if (node.IsSequence()) {
      for (const auto& each : node) {
        if (each.IsScalar()) found.push_back(trimmed(each.Scalar()));
      }
    } else if (node.IsMap()) {
      for (const auto& each : node) found.push_back(trimmed(each.first.Scalar()));
    } else {
      split(node.Scalar(), found);
    }
    std::erase_if(found, [](const auto& each) { return each.empty() || each == "?"; });
    return found;
  }
  std::vector<std::string> list(const std::string& key) const { return list(node(key)); }

  static void split(const std::string& text, std::vector<std::string>& found) {
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      found.push_back(trimmed(text.substr(begin, end - begin)));
      begin = end + 1;
    }
  }

  std::string runtime() const {
    const auto types = list("performance_type"), measures = list("performance_measures");
    for (std::size_t i = 0; i < types.size(); ++i) {
      if (lower(types[i]) != "runtime") continue;
      return i < measures.size() ? measures[i] : "runtime";
    }
    refuse(mark("performance_type"), "no performance_type is 'runtime'",
           "only scenarios that measure a runtime can be replayed in time");
  }

  double cutoff_s() const {
    const auto text = list("algorithm_cutoff_time");
    try {
      const double value = YAML::Node(text.empty() ? "?" : text.front()).as<double>();
      if (value > 0 && value <= kMostSeconds) return value;
    } catch (const YAML::Exception&) {
    }
    refuse(mark("algorithm_cutoff_time"), "algorithm_cutoff_time is no time",
           "write the seconds after which a run was stopped: a positive number up to 1e8");
  }

  std::vector<std::string> algorithms() const {
    auto found = list("metainfo_algorithms");
    if (found.empty()) {
      found = list("algorithms_deterministic");
      const auto others = list("algorithms_stochastic");
      found.insert(found.end(), others.begin(), others.end());
    }
    std::ranges::sort(found);
    const auto twice = std::ranges::unique(found);
    found.erase(twice.begin(), twice.end());
    return found;
  }

  void read_steps(Description& found) const {
    const YAML::Node steps = node("feature_steps");
    if (steps.IsNull() || (steps.IsScalar() && list(steps).empty())) return;
    if (!steps.IsMap()) {
      refuse(steps.Mark(), "feature_steps has no names",
             "write `NAME:` per step, and below it `provides:` and a list of features");
    }
    for (const auto& step : steps) read_step(step.first, step.second, found);
  }

  void read_step(const YAML::Node& name, const YAML::Node& step, Description& found) const {
    if (!step.IsMap()) {
      refuse(name.Mark(), "feature step '" + name.Scalar() + "' does not say what it provides",
             "write `provides:` and a list of features below it");
    }
    found.steps[trimmed(name.Scalar())] = {list(step["provides"]), list(step["requires"])};
  }

  /// Steps of features of algorithms stand among the default ones.
  void leave_out_algorithm_steps(Description& found) const {
    found.algorithm_steps = list("algorithm_feature_steps");
    std::erase_if(found.default_steps, [&](const std::string& name) {
      return !found.steps.contains(name) &&
             std::ranges::find(found.algorithm_steps, name) != found.algorithm_steps.end();
    });
  }

  void check_steps(const Description& found) const {
    for (const auto& name : found.used_steps()) {
      if (found.steps.contains(name)) continue;
      refuse(mark(found.steps.empty() ? "default_steps" : "feature_steps"),
             "feature step '" + name + "' is used, but feature_steps does not have it",
             "add it there, or correct default_steps and requires");
    }
  }

  static constexpr double kMostSeconds = 1e8;  // ten times as many fit into a Duration

  std::filesystem::path file_;
  YAML::Node root_;
};

}  // namespace

std::vector<std::string> Description::used_steps() const {
  std::vector<std::string> used = default_steps;
  if (used.empty()) {
    for (const auto& [name, step] : steps) used.push_back(name);
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto step = steps.find(used[i]);
    if (step == steps.end()) continue;
    for (const std::string& name : step->second.requires_steps) {
      if (std::ranges::find(used, name) == used.end()) used.push_back(name);
    }
  }
  return used;
}

Description read_description(const std::filesystem::path& file) {
  return DescriptionReader(file).read();
}

}  // namespace skein::benchmarks::selection
