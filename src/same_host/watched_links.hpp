#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>

#include "core/system/epoll.hpp"
#include "link.hpp"

namespace skein::same_host {

/// By errno: a meeting gets no descriptor, or none into its epoll.
[[noreturn]] void refuse_to_meet();

/// Watches links through an epoll for their end: the socket hangs up, or the process at the other
/// end ends. A child of that process may keep the socket open. Not thread-safe.
class WatchedLinks {
 public:
  /// `epoll` outlives it.
  explicit WatchedLinks(Epoll& epoll) : epoll_(epoll) {}

  /// `guest`, if any, is the process of the client. Throws Unavailable if the kernel refuses.
  void add(const std::shared_ptr<Link>& link, std::optional<pid_t> guest);
  /// The link of the event with this number has ended. Returns it if anybody uses it still; null
  /// also for an unknown number.
  std::shared_ptr<Link> remove(std::uint64_t id);

  std::size_t guests() const { return guests_; }
  std::size_t guests_of(pid_t process) const;
  bool has_guest(const Guid& client) const;

 private:
  struct Watched {
    std::uint64_t id = 0;
    std::shared_ptr<const FileDescriptor> socket;
    std::uint64_t process_id = 0;  // 0: the kernel tells of no process
    FileDescriptor process;
    std::weak_ptr<Link> link;
    std::optional<pid_t> guest;
  };

  Epoll& epoll_;
  std::unordered_map<std::uint64_t, std::shared_ptr<const Watched>> links_;
  std::size_t guests_ = 0;
};

}  // namespace skein::same_host
