#include "core/threads/start_thread.hpp"

#include <string>

#include "skein/error.hpp"

namespace skein {

void refuse_thread(std::string_view name, const std::system_error& reason) {
  throw Unavailable("the thread '" + std::string(name) +
                    "' cannot be started: " + reason.code().message() +
                    "; use fewer threads, or raise the limit on them (ulimit -u, systemd's "
                    "TasksMax, a container's pids) or on address space (ulimit -v)");
}

}  // namespace skein
