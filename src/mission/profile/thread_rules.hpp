#pragma once

#include <cstddef>

#include "skein/executor.hpp"

namespace skein::profile {

/// On which threads one service runs, and how.
struct ThreadRules {
  CallThread thread = CallThread::Own;
  std::size_t count = 0;  ///< 0: as many as the implementation says.
  ThreadSettings settings;
  bool lock_memory = false;  ///< Of the whole process.
};

}  // namespace skein::profile
