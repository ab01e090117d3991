#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>

#include "core/system/file_descriptor.hpp"
#include "link.hpp"

namespace skein::same_host {

/// Links whose end the kernel reports to an epoll: the socket hangs up, or the process at the other
/// end ends, of which a child may keep the socket open. Not thread-safe.
class WatchedLinks {
 public:
  /// `epoll` outlives it.
  explicit WatchedLinks(const FileDescriptor& epoll) : epoll_(epoll) {}

  /// The link is known by two numbers of the epoll, the two after `last_id`. `guest`, if any, is
  /// the process whose link it is. Throws Unavailable if the kernel refuses.
  void add(const std::shared_ptr<Link>& link, std::optional<pid_t> guest, std::uint64_t& last_id);
  /// The link that is known by this number has ended. Returns it if anybody uses it still; null
  /// also for an unknown number.
  std::shared_ptr<Link> remove(std::uint64_t id);

  std::size_t guests() const { return guests_; }
  std::size_t guests_of(pid_t process) const;
  bool has_guest(const Guid& client) const;

 private:
  struct Watched {
    std::uint64_t id = 0;
    std::shared_ptr<const FileDescriptor> socket;
    std::uint64_t process_id = 0;
    FileDescriptor process;
    std::weak_ptr<Link> link;
    std::optional<pid_t> guest;
  };

  const FileDescriptor& epoll_;
  std::unordered_map<std::uint64_t, std::shared_ptr<const Watched>> links_;
  std::size_t guests_ = 0;
};

}  // namespace skein::same_host
