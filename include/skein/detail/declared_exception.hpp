#pragma once

#include <memory>
#include <string>

#include "skein/detail/operation.hpp"

namespace skein::idl {

/// Base of generated exceptions: a readable what(), made when it is first called. Several threads
/// may call it on one object.
class DeclaredException : public UserException {
 public:
  DeclaredException() = default;
  DeclaredException(const DeclaredException& other) : UserException(other) {}
  DeclaredException& operator=(const DeclaredException& other);

  /// Name and members: `A::NoRoute{reason="fog"}`.
  const char* what() const noexcept override;

 protected:
  virtual std::string text() const = 0;

 private:
  mutable std::shared_ptr<const std::string> text_;
};

}  // namespace skein::idl
