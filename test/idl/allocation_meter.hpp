#pragma once

#include <cstddef>

/// Counts the bytes that operator new has handed out on this thread since it was made.
class AllocationMeter {
 public:
  AllocationMeter() : start_(total()) {}
  std::size_t allocated() const { return total() - start_; }

 private:
  static std::size_t total();

  std::size_t start_;
};
