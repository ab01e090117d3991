#include "requests.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "core/printable.hpp"
#include "request_members.hpp"
#include "skein/error.hpp"

namespace skein::command::designer {
namespace {

using Json = nlohmann::json;

/// It is one line to the launcher.
std::string process_of(const Json& request) {
  std::string process = text_of(request, "process");
  constexpr std::size_t kLongestName = 512;
  if (process.size() <= kLongestName && process.find('\n') == std::string::npos) return process;
  throw InvalidArgument("no process has such a name");
}

std::string ask_about(const Json& request, const std::string& what, const Actions& actions) {
  constexpr double kMostProcesses = 1 << 22;
  return actions.ask_launcher(static_cast<int>(number_of(request, "launcher", kMostProcesses)),
                              what);
}

std::string do_fault(const Json& request, const std::string& fault, const Actions& actions) {
  if (!actions.faults) {
    throw InvalidArgument(
        "only with --faults are processes killed and made to hang: it is for "
        "missions in which nothing real can break");
  }
  return ask_about(request, fault + " " + process_of(request), actions);
}

}  // namespace

std::string obey(std::string_view text, const Actions& actions) {
  const Json request = request_of(text);
  const std::string what = text_of(request, "do");
  if (what == "stop") return ask_about(request, what, actions);
  if (what == "restart") return ask_about(request, what + " " + process_of(request), actions);
  if (what == "kill" || what == "hang") return do_fault(request, what, actions);
  if (what == "move") {
    actions.move(text_of(request, "entity"),
                 {number_of(request, "x", kFarthest), number_of(request, "y", kFarthest)});
    return "moved";
  }
  if (what == "arrange") {
    actions.arrange();
    return "arranged";
  }
  throw InvalidArgument("'" + printable(what) +
                        "' can not be asked for; restart, stop, kill, hang, move and arrange can");
}

bool asks_launcher(std::string_view text) {
  const Json request = Json::parse(text, nullptr, false);
  return request.is_object() && request.contains("launcher");
}

}  // namespace skein::command::designer
