#pragma once

#include <sys/types.h>

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/system/file_descriptor.hpp"

namespace skein::command::compose {

/// A mission that was launched from here: a launcher in a session of its own, which flies it to its
/// end also after this object's.
class Flight {
 public:
  /// `words`: the launcher's command line. Throws Unavailable if it does not start.
  explicit Flight(const std::vector<std::string>& words);
  ~Flight();
  Flight(const Flight&) = delete;
  Flight& operator=(const Flight&) = delete;

  /// How it has ended, in words, with what the launcher said at last; empty: it flies.
  std::string end() const;

 private:
  void run();
  void read();

  FileDescriptor said_;  // what the launcher says of itself, until it has ended
  pid_t process_ = 0;
  std::atomic<bool> forgotten_{false};
  mutable std::mutex mutex_;
  std::string last_;  // of what it said
  std::string end_;
  std::thread thread_;  // last: it uses the rest
};

}  // namespace skein::command::compose
