#include "doorbell.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

#include "skein/error.hpp"

namespace skein::same_host {
namespace {

constexpr std::uint64_t kOwn = 0;

// The edge tells of each ring, so that nobody need read the counter.
bool watch(const FileDescriptor& epoll, const FileDescriptor& doorbell, std::uint64_t id) noexcept {
  epoll_event event{};
  event.events = EPOLLIN | EPOLLET;
  event.data.u64 = id;
  return epoll_ctl(epoll.get(), EPOLL_CTL_ADD, doorbell.get(), &event) == 0;
}

[[noreturn]] void refuse() {
  throw Unavailable(std::string("cannot watch for calls on this host: ") + std::strerror(errno));
}

}  // namespace

// Its counter is 1 for ever, and so it is always readable: only the edges tell.
FileDescriptor make_doorbell() noexcept {
  return FileDescriptor(eventfd(1, EFD_CLOEXEC | EFD_NONBLOCK));
}

// Adds nothing: there is room for that also where the other side has filled the counter, and made
// the descriptor blocking. The kernel tells of the edge all the same.
void ring(const FileDescriptor& doorbell) noexcept {
  if (doorbell) eventfd_write(doorbell.get(), 0);
}

// The name tells without asking whoever implements the file: fstat() of a file in FUSE waits.
bool is_doorbell(const FileDescriptor& descriptor) noexcept {
  constexpr std::string_view kEventfd = "anon_inode:[eventfd]";
  const std::string path = "/proc/self/fd/" + std::to_string(descriptor.get());
  char name[kEventfd.size() + 1];
  const auto size = readlink(path.c_str(), name, sizeof name);
  return size > 0 && std::string_view(name, static_cast<std::size_t>(size)) == kEventfd;
}

// Not before there is need: a service that nobody calls through shared memory takes none.
void Doorbells::open() {
  std::lock_guard lock(mutex_);
  if (own_) return;
  FileDescriptor epoll(epoll_create1(EPOLL_CLOEXEC));
  FileDescriptor own = make_doorbell();
  if (!epoll || !own || !watch(epoll, own, kOwn)) refuse();
  epoll_ = std::move(epoll);
  own_ = std::move(own);
}

void Doorbells::add(const FileDescriptor& doorbell, std::uint64_t id) {
  open();
  if (!watch(epoll_, doorbell, id)) refuse();
}

void Doorbells::remove(const FileDescriptor& doorbell) noexcept {
  epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, doorbell.get(), nullptr);
}

// Sequentially consistent with wait(): either it sees the call, or this sees that it sleeps. For
// that both flags are written before the other one is read.
void Doorbells::call() noexcept {
  if (!called_.exchange(true) && sleeps_) ring(own_);
}

std::span<const std::uint64_t> Doorbells::wait(std::optional<std::chrono::milliseconds> longest) {
  const int timeout = longest ? static_cast<int>(longest->count()) : -1;
  if (timeout != 0) sleeps_ = true;
  const int count = epoll_wait(epoll_.get(), events_.data(), kAtOnce, called_ ? 0 : timeout);
  if (timeout != 0) sleeps_ = false;
  std::size_t rung = 0;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t id = events_[static_cast<std::size_t>(i)].data.u64;
    if (id != kOwn) rung_[rung++] = id;
  }
  return std::span(rung_).first(rung);
}

}  // namespace skein::same_host
