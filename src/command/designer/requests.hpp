#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "layout.hpp"

namespace skein::command::designer {

/// The actions that the page can request.
struct Actions {
  std::function<std::string(int launcher, const std::string& request)> ask_launcher;
  std::function<void(const std::string& entity, Place to)> move;
  std::function<void()> arrange;
  bool faults = false;  ///< Whether processes may be killed and made to hang.
};

/// Carries out a request, a JSON object: `{"request": 7, "do": "restart", "launcher": 4711,
/// "process": "navigator"}`, `stop` with a launcher, `kill` and `hang` as `restart`, `move` with
/// `entity`, `x` and `y`, and `arrange`. Returns the effect in words. Throws InvalidArgument for
/// other requests, and passes on the exceptions of `actions`.
std::string obey(std::string_view request, const Actions& actions);

/// Whether it asks a launcher, which may take some seconds to answer.
bool asks_launcher(std::string_view request);

}  // namespace skein::command::designer
