#include "conversion.hpp"

#include <memory>

#include "skein/detail/bytes.hpp"

namespace skein::rpc {
namespace {

/// Throws what `error` is, as `operation` declares it.
void rethrow(const std::exception_ptr& error, const OperationInfo& operation) {
  try {
    std::rethrow_exception(error);
  } catch (const UserException& exception) {
    for (const ExceptionInfo* declared : operation.raises) {
      if (declared->hash != exception.info().hash || declared == &exception.info()) continue;
      const std::unique_ptr<void, void (*)(void*)> value(declared->type->make(),
                                                         declared->type->destroy);
      convert(*exception.info().type, exception.value(), *declared->type, value.get());
      declared->raise(value.get());
    }
    throw;
  }
}

}  // namespace

void convert(const TypeSupport& from_type, const void* from, const TypeSupport& to_type, void* to) {
  if (&from_type == &to_type) return to_type.assign(to, from);
  const auto header = encapsulation(from_type.representation);
  Bytes message{std::span<const std::byte>(header)};
  from_type.encode(from, message);
  to_type.decode(to, message, header.size());
}

std::exception_ptr convert(const std::exception_ptr& error, const OperationInfo& operation) {
  if (!error) return error;
  try {
    rethrow(error, operation);
  } catch (...) {
    return std::current_exception();
  }
  return error;
}

}  // namespace skein::rpc
