#include "servant_call.hpp"

#include <algorithm>
#include <exception>
#include <span>
#include <string>

#include "idl/encode_value.hpp"
#include "rpc/wire/common.hpp"
#include "skein/detail/bytes.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/detail/channel.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

bool declares(const OperationInfo& operation, const ExceptionInfo& exception) {
  return std::any_of(
      operation.raises.begin(), operation.raises.end(),
      [&](const ExceptionInfo* declared) { return declared->hash == exception.hash; });
}

void check_declared(const OperationInfo& operation, const UserException& exception) {
  if (declares(operation, exception.info())) return;
  throw Internal(quoted(operation) + " threw " + std::string(exception.info().name) +
                 ", which its interface does not declare");
}

void check_sendable(const OperationInfo& operation, const UserException& exception) {
  Bytes message{std::span<const std::byte>(encapsulation(exception.info().type->representation))};
  try {
    idl::encode_value(*exception.info().type, exception.value(), message);
  } catch (const std::exception& reason) {
    throw Internal("the exception " + std::string(exception.info().name) + " of " +
                   quoted(operation) + " cannot be sent: " + reason.what());
  }
}

// What is being handled now, as every caller gets it.
[[noreturn]] void rethrow(const OperationInfo& operation) {
  try {
    throw;
  } catch (const UserException& exception) {
    check_declared(operation, exception);
    check_sendable(operation, exception);
    throw;
  } catch (const NotSent& error) {
    throw Unavailable(error.what());  // a call of the implementation was not sent; this one was
  } catch (const Error&) {
    throw;
  } catch (const std::exception& failure) {
    throw Internal(quoted(operation) + " failed: " + failure.what());
  } catch (...) {
    throw Internal(quoted(operation) + " threw something that is no std::exception");
  }
}

}  // namespace

void call_servant(Servant& servant, const OperationInfo& operation, const void* in, void* out) {
  try {
    servant.dispatch(operation, in, out);
  } catch (...) {
    rethrow(operation);
  }
}

void throw_for_caller(const OperationInfo& operation, const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (...) {
    rethrow(operation);
  }
}

}  // namespace skein::rpc
