#include "pass_descriptor.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace skein::same_host {
namespace {

// As many as the kernel lets anybody send (SCM_MAX_FD): it would close the others here.
constexpr std::size_t kMostDescriptors = 253;

}  // namespace

bool pass(int socket, std::span<const std::byte> packet, std::initializer_list<int> descriptors) {
  const std::size_t size_passed = std::min(descriptors.size(), kMostPassed) * sizeof(int);
  iovec content{const_cast<std::byte*>(packet.data()), packet.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(kMostPassed * sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &content;
  message.msg_iovlen = 1;
  if (size_passed != 0) {
    message.msg_control = control;
    message.msg_controllen = CMSG_SPACE(size_passed);
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(size_passed);
    std::memcpy(CMSG_DATA(header), descriptors.begin(), size_passed);
  }
  return sendmsg(socket, &message, MSG_NOSIGNAL | MSG_DONTWAIT) ==
         static_cast<ssize_t>(packet.size());
}

bool receive_passed(int socket, std::span<std::byte> packet, std::span<HandedOver> descriptors) {
  iovec content{packet.data(), packet.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(kMostDescriptors * sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &content;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const auto size = recvmsg(socket, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  if (size < 0) return false;
  std::size_t kept = 0;
  for (auto* header = CMSG_FIRSTHDR(&message); header; header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_RIGHTS) continue;
    for (std::size_t at = CMSG_LEN(0); at + sizeof(int) <= header->cmsg_len; at += sizeof(int)) {
      int number = -1;
      std::memcpy(&number, reinterpret_cast<const char*>(header) + at, sizeof number);
      HandedOver descriptor{FileDescriptor(number)};
      if (kept < descriptors.size()) descriptors[kept++] = std::move(descriptor);
    }
  }
  return size == static_cast<ssize_t>(packet.size()) && (message.msg_flags & MSG_TRUNC) == 0;
}

}  // namespace skein::same_host
