#include "reply_reading.hpp"

#include "skein/error.hpp"

namespace skein::rpc {
namespace {

std::exception_ptr raised(const ExceptionInfo& exception, const void* value) {
  try {
    exception.raise(value);
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;  // raise() throws
}

std::exception_ptr read_exception(const OperationInfo& operation, std::uint32_t which,
                                  std::span<const std::byte> message, std::size_t offset) {
  for (const ExceptionInfo* exception : operation.raises) {
    if (exception->hash != which) continue;
    const std::unique_ptr<void, void (*)(void*)> value(exception->type->make(),
                                                       exception->type->destroy);
    exception->type->decode(value.get(), message, offset);
    return raised(*exception, value.get());
  }
  throw InvalidArgument("it is an exception that this side's interface does not declare");
}

}  // namespace

Reply read_reply(const OperationInfo& operation, void* out, std::span<const std::byte> message,
                 const wire::ReplyHead& head, const std::string& peer) {
  if (head.exception != wire::RemoteException::Ok) {
    return {error_in(message, head, operation.name, peer)};
  }
  if (head.operation != operation.hash) {
    throw InvalidArgument("it is the result of another operation");
  }
  std::size_t offset = head.result;
  const std::uint32_t which = wire::read_discriminator(message, offset);
  if (which != 0) return {read_exception(operation, which, message, offset)};
  const std::size_t end = operation.out->decode(out, message, offset);
  Reply reply;
  if (!operation.stream) return reply;
  if (const auto trailer = wire::read_reply_trailer(message, end)) {
    reply.part = trailer->part;
    reply.position = trailer->position;
  }
  return reply;
}

std::exception_ptr error_in(std::span<const std::byte> message, const wire::ReplyHead& head,
                            std::string_view operation, const std::string& peer) {
  ErrorCode code = wire::error_code_of(head.exception);
  std::string text = std::string(operation) + " ended with remote exception " +
                     std::to_string(static_cast<int>(head.exception));
  if (head.exception == wire::RemoteException::UnknownOperation) {
    text = "it has no operation '" + std::string(operation) + "'; its IDL is another version";
  } else if (const auto trailer = wire::read_reply_trailer(message, head.result + 1)) {
    code = trailer->code;
    text = trailer->text;
  }
  try {
    throw_error(code, peer + ": " + text);
  } catch (...) {
    return std::current_exception();
  }
}

}  // namespace skein::rpc
