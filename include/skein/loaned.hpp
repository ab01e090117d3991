#pragma once

#include <memory>
#include <type_traits>
#include <utility>

#include "skein/detail/lendable.hpp"
#include "skein/detail/loan_memory.hpp"
#include "skein/error.hpp"

namespace skein {

/// A large value that a provider in another process of this host may read in place. Passed as
/// in `survey.store(*image)`, it reaches the provider unchanged, lent or copied; only the time
/// differs. The fastest call is one that waits for its answer, with one such parameter of 4 KiB or
/// more, through shared memory, to a provider in C++. Up to eight values of a connection can be
/// lent, each of up to 256 MiB; a copied one must fit into that with the rest of the call.
///
/// Leave it as it is from a call's begin to its answer. If a call ends without one, in_use() tells
/// whether the provider may still read it. It may be destroyed at any time: readers keep the
/// memory. Not thread-safe, as any value.
///
/// T is an array or a struct of numbers and octets alone (see Lendable), so that any octets
/// written to it while it is read are a value, too. All are zero at first. Making one takes system
/// calls, and its pages are new to both processes: keep it for many calls.
///
/// ```cpp
/// auto archive = station.connect<survey::IArchive>();
/// skein::Loaned<survey::Image> image;  // once, for many calls
/// image->pixels.fill(128);
/// const std::uint32_t number = archive.store(*image);
/// ```
template <Lendable T>
class Loaned {
 public:
  /// Throws Unavailable where the kernel gives no memory.
  Loaned() : memory_(LoanMemory::make(sizeof(T))) {}
  /// What was moved from can only be destroyed, or given another one; its use throws
  /// InvalidArgument.
  Loaned(Loaned&&) noexcept = default;
  Loaned& operator=(Loaned&&) noexcept = default;

  T& operator*() { return *value(); }
  const T& operator*() const { return *value(); }
  T* operator->() { return value(); }
  const T* operator->() const { return value(); }

  /// Whether an implementation that it was passed to may still read it.
  bool in_use() const { return memory().is_read(); }

 private:
  LoanMemory& memory() const {
    if (memory_) return *memory_;
    throw InvalidArgument("this loan was moved from; use the object that it was moved to");
  }
  T* value() const { return static_cast<T*>(memory().data()); }

  std::shared_ptr<LoanMemory> memory_;
};

}  // namespace skein
