#include "skein/detail/declared_exception.hpp"

#include <mutex>

namespace skein::idl {

DeclaredException& DeclaredException::operator=(const DeclaredException& other) {
  UserException::operator=(other);
  if (this != &other) text_.reset();
  return *this;
}

const char* DeclaredException::what() const noexcept try {
  static std::mutex mutex;  // of all objects: what() is seldom called
  const std::lock_guard lock(mutex);
  if (!text_) text_ = std::make_shared<const std::string>(text());
  return text_->c_str();
} catch (...) {
  return UserException::what();
}

}  // namespace skein::idl
