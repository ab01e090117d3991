#pragma once

#include <cstddef>

#include "skein/core/thread_settings.hpp"

namespace skein::profile {

/// How the threads of one service run.
struct ThreadRules {
  std::size_t count = 0;  ///< 0: as many as the implementation says.
  ThreadSettings settings;
  bool lock_memory = false;  ///< Of the whole process.
};

}  // namespace skein::profile
