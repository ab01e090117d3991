#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "skein/detail/version.hpp"

namespace skein {

/// Memory that other processes can read and this one alone can write; all zero at first. Its size
/// cannot change. Thread-safe, but for its content.
class LoanMemory {
 public:
  /// One who can read it, at the other end of a connection. Thread-safe.
  class Reader {
   public:
    virtual ~Reader() = default;
    /// Whether he is at it, or may still begin.
    virtual bool reads() const = 0;
    /// Whether he may begin again, though he is not at it now.
    virtual bool may_return() const = 0;
    /// The memory goes: what he keeps of it is of no use any more. Must not throw.
    virtual void forget() = 0;
  };

  /// Throws Unavailable where the kernel gives none.
  static std::shared_ptr<LoanMemory> make(std::size_t size);
  /// The living one that begins there, or null.
  static std::shared_ptr<LoanMemory> find(const void* address);

  ~LoanMemory();
  LoanMemory(const LoanMemory&) = delete;
  LoanMemory& operator=(const LoanMemory&) = delete;

  void* data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }
  int descriptor() const noexcept { return descriptor_; }

  void add(std::shared_ptr<Reader> reader);
  bool is_read() const;

 private:
  LoanMemory(int descriptor, void* data, std::size_t size);

  const int descriptor_;
  void* const data_;
  const std::size_t size_;
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<Reader>> readers_;
};

}  // namespace skein
