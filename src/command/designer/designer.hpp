#pragma once

#include "command/commands.hpp"

namespace skein::command::designer {

/// A page that shows a domain while missions fly there, until interrupted.
int watch_domain(const DesignerArguments& arguments);

/// The same over a recording.
int replay(const DesignerArguments& arguments);

}  // namespace skein::command::designer
