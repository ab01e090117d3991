#pragma once

#include <utility>

#include "file_descriptor.hpp"

namespace skein {

/// close() waits for as long as another process likes if the descriptor is one that it handed over,
/// such as a TCP connection that lingers, or a local socket that holds such a descriptor unread.
/// These are closed on threads of their own, `skein-closing`, for which nobody waits.

/// Never waits; from any thread, also under a lock. Ignores a descriptor that is none.
void close_elsewhere(FileDescriptor descriptor) noexcept;

/// The same for a local socket, whose other side sees the end at once.
void hang_up_elsewhere(FileDescriptor socket) noexcept;

/// Whether so many are still open that no more should be accepted.
bool closing_is_behind() noexcept;

/// A descriptor of any kind that another process handed over, or may have handed one over to.
struct HandedOver : FileDescriptor {
  HandedOver() = default;
  HandedOver(FileDescriptor descriptor) : FileDescriptor(std::move(descriptor)) {}
  HandedOver(HandedOver&&) = default;
  HandedOver& operator=(HandedOver&& other) noexcept {
    close_elsewhere(std::move(*this));
    FileDescriptor::operator=(std::move(other));
    return *this;
  }
  ~HandedOver() { close_elsewhere(std::move(*this)); }
};

}  // namespace skein
