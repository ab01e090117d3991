#include "core/system/close_elsewhere.hpp"

#include <pthread.h>
#include <sys/socket.h>

#include <csignal>
#include <cstddef>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace skein {
namespace {

constexpr std::size_t kMostThreads = 16;
constexpr std::size_t kMostOpen = 64;

class Closing {
 public:
  void add(FileDescriptor descriptor) {
    std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(descriptor));
    if (threads_ < kMostThreads) start();
  }

  bool behind() {
    std::lock_guard lock(mutex_);
    return threads_ + waiting_.size() >= kMostOpen;
  }

 private:
  // Under the lock. If the system gives no thread, the next call tries again.
  void start() {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    try {
      std::thread([this] { run(); }).detach();
      ++threads_;
    } catch (const std::system_error&) {
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  void run() {
    pthread_setname_np(pthread_self(), "skein-closing");
    std::unique_lock lock(mutex_);
    while (!waiting_.empty()) {
      FileDescriptor next = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      next.reset();
      lock.lock();
    }
    --threads_;
  }

  std::mutex mutex_;
  std::deque<FileDescriptor> waiting_;
  std::size_t threads_ = 0;
};

// Never destroyed: a thread may be stuck when the process ends.
Closing& closing() {
  static auto& only = *new Closing;
  return only;
}

}  // namespace

void close_elsewhere(FileDescriptor descriptor) noexcept {
  if (descriptor) closing().add(std::move(descriptor));
}

void hang_up_elsewhere(FileDescriptor socket) noexcept {
  shutdown(socket.get(), SHUT_RDWR);
  close_elsewhere(std::move(socket));
}

bool closing_is_behind() noexcept { return closing().behind(); }

}  // namespace skein
