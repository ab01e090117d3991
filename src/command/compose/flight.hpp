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

  /// The end in words, with the reason that the launcher gives; empty: it flies.
  std::string end() const;

 private:
  void run();
  bool read();

  FileDescriptor said_;  // the launcher's standard error
  pid_t process_ = 0;
  std::atomic<bool> forgotten_{false};
  mutable std::mutex mutex_;
  std::string last_;  // the end of its output
  std::string end_;
  std::thread thread_;  // last: it uses the rest
};

}  // namespace skein::command::compose
