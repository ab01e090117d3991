#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace skein::launch {

/// Cuts a stream of bytes into lines. A line that does not end is cut at kLongestLine, so that a
/// child cannot fill the launcher's memory.
class LineSplitter {
 public:
  static constexpr std::size_t kLongestLine = 64 * 1024;
  using OnLine = std::function<void(std::string_view line)>;

  void add(std::string_view bytes, const OnLine& on_line);
  /// The stream ended: what is left is the last line.
  void finish(const OnLine& on_line);

 private:
  std::string rest_;
};

}  // namespace skein::launch
