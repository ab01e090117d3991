#include "skein/detail/declared_exception.hpp"

#include <atomic>

namespace skein::idl {

DeclaredException& DeclaredException::operator=(const DeclaredException& other) {
  UserException::operator=(other);
  if (this != &other) text_.reset();
  return *this;
}

const char* DeclaredException::what() const noexcept try {
  auto current = std::atomic_load(&text_);
  if (!current) {
    const auto made = std::make_shared<const std::string>(text());
    if (std::atomic_compare_exchange_strong(&text_, &current, made)) return made->c_str();
  }
  return current->c_str();
} catch (...) {
  return UserException::what();
}

}  // namespace skein::idl
