#pragma once

#include <memory>
#include <string>

#include "skein/core/operation.hpp"

namespace skein::idl {

/// What generated exceptions share: a readable what(), made when it is first asked for. Several
/// threads may ask one exception object.
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
