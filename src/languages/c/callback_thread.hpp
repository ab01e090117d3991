#pragma once

#include "skein/executor.hpp"

namespace skein::c {

/// The process's thread for callbacks that come where no user's code may run; never destroyed. It
/// is made when it is first needed.
ThreadExecutor& callback_thread();

}  // namespace skein::c
