#pragma once

#include <memory>

namespace skein {

/// Keeps something for the rest of the process's life: what a thread may still use that was stuck
/// when its owner ended. Thread-safe.
void leave_behind(std::shared_ptr<const void> used);

}  // namespace skein
