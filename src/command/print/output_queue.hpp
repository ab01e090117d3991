#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace skein::command {

/// Lines for stdout and stderr, written by a thread of its own: who adds them never waits for who
/// reads them. They are written in the order in which they were added, but where one of the two
/// takes nothing, the other's lines overtake. Lines without room are left out; how many, is said
/// when there is room again.
///
/// SIGPIPE must be ignored: a reader that has gone is then one more reason why lines are lost.
class OutputQueue {
 public:
  /// `room`: how many bytes may wait for each of the two. `patience`: how long the end waits for
  /// readers, in all.
  explicit OutputQueue(std::size_t room = 1 << 20,
                       std::chrono::milliseconds patience = std::chrono::seconds(2));
  /// Waits as flush() does, and leaves behind a write that hangs.
  ~OutputQueue();
  OutputQueue(const OutputQueue&) = delete;
  OutputQueue& operator=(const OutputQueue&) = delete;

  /// The line has no line break.
  void add(int descriptor, const std::string& line);
  /// Waits until all is written, or patience is over. Why something was not, or will not be; or
  /// empty.
  std::string flush();

 private:
  struct State;

  std::shared_ptr<State> state_;  // the thread's, too
  const std::chrono::milliseconds patience_;
  std::optional<std::chrono::steady_clock::time_point> last_moment_;
  std::thread thread_;
};

}  // namespace skein::command
