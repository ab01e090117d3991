#pragma once

namespace skein::test {

/// What Linux grants a socket's buffer unless its administrator allows more (net.core.rmem_max).
inline constexpr int kDefaultSocketBuffer = 212'992;

/// While this lives, no socket of this process is granted a larger buffer, as on a host with such a
/// limit: the limit itself is the whole machine's, and not for a test to change.
class SocketBuffersOfAtMost {
 public:
  explicit SocketBuffersOfAtMost(int bytes);
  ~SocketBuffersOfAtMost();
  SocketBuffersOfAtMost(const SocketBuffersOfAtMost&) = delete;
  SocketBuffersOfAtMost& operator=(const SocketBuffersOfAtMost&) = delete;
};

}  // namespace skein::test
