#include "mission/process/address_space.hpp"

#include <sys/mman.h>
#include <sys/resource.h>

#include <string>

#include "skein/error.hpp"

namespace skein::launch {
namespace {

/// Stacks of a participant's ten to fifteen threads are 8 MiB each; with 250 MB in all, some starts
/// of a peer failed.
constexpr std::size_t kNeededMiB = 256;

}  // namespace

std::string address_space_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return {};
  return "the address space of a process is limited to " + std::to_string(limit.rlim_cur >> 20) +
         " MiB here (ulimit -v)";
}

void demand_address_space() {
  const std::string limit = address_space_limit();
  if (limit.empty()) return;
  constexpr std::size_t kNeeded = kNeededMiB << 20;
  void* const room =
      ::mmap(nullptr, kNeeded, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room != MAP_FAILED) {
    ::munmap(room, kNeeded);
    return;
  }
  throw Unavailable(limit + ", and an entity needs " + std::to_string(kNeededMiB) +
                    " MiB beside what is in use, for its threads; raise the limit, or limit memory "
                    "by a control group instead");
}

}  // namespace skein::launch
