#pragma once

#include <sys/epoll.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/system/file_descriptor.hpp"
#include "skein/error.hpp"

namespace skein::same_host {

/// False, with errno, if the kernel refuses.
inline bool control_epoll(const FileDescriptor& epoll, int operation, const FileDescriptor& of,
                          std::uint64_t id, std::uint32_t events) {
  epoll_event event{};
  event.events = events;
  event.data.u64 = id;
  return epoll_ctl(epoll.get(), operation, of.get(), &event) == 0;
}

/// By errno: a meeting gets no descriptor, or none into its epoll.
[[noreturn]] inline void refuse_to_meet() {
  throw Unavailable(std::string("cannot open the socket by which callers on this host come: ") +
                    std::strerror(errno));
}

}  // namespace skein::same_host
