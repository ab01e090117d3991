#include "reply_encoding.hpp"

#include <memory>

#include "skein/core/error.hpp"

namespace skein::rpc {
namespace {

using wire::RequestId;

bool declares(const OperationInfo& operation, const ExceptionInfo& exception) {
  for (const ExceptionInfo* declared : operation.raises) {
    if (declared->hash == exception.hash) return true;
  }
  return false;
}

void encode_result(Bytes& message, const RequestId& id, const OperationInfo& operation,
                   const void* out) {
  wire::begin_reply(message, id, wire::RemoteException::Ok, operation.hash);
  wire::append_discriminator(message, 0);
  operation.out->encode(out, message);
}

}  // namespace

void encode_error(Bytes& message, const RequestId& id, ErrorCode code, const std::string& text,
                  std::uint32_t operation) {
  wire::begin_reply(message, id, wire::remote_exception_of(code), operation);
  wire::append_default_branch(message);
  wire::append_trailer(message, wire::ReplyTrailer{code, text});
}

void encode_outcome(Bytes& message, const RequestId& id, const OperationInfo& operation,
                    const void* out, const std::exception_ptr& error) {
  try {
    if (error) std::rethrow_exception(error);
    encode_result(message, id, operation, out);
  } catch (const UserException& exception) {
    if (!declares(operation, exception.info())) {
      return encode_error(message, id, ErrorCode::Internal,
                          std::string(operation.name) + " threw " +
                              std::string(exception.info().name) +
                              ", which its interface does not declare");
    }
    wire::begin_reply(message, id, wire::RemoteException::Ok, operation.hash);
    wire::append_discriminator(message, exception.info().hash);
    exception.info().type->encode(exception.value(), message);
  } catch (const Error& failure) {
    encode_error(message, id, failure.code(), failure.what());
  } catch (const std::exception& failure) {
    encode_error(message, id, ErrorCode::Internal,
                 std::string(operation.name) + " failed: " + failure.what());
  } catch (...) {
    encode_error(message, id, ErrorCode::Internal,
                 std::string(operation.name) + " threw something that is no std::exception");
  }
}

void encode_item(Bytes& message, const RequestId& id, const OperationInfo& operation,
                 const void* out, std::uint64_t position) {
  encode_result(message, id, operation, out);
  wire::append_trailer(message, wire::ReplyTrailer{{}, {}, wire::StreamPart::Item, position});
}

void encode_end(Bytes& message, const RequestId& id, const OperationInfo& operation,
                std::uint64_t position) {
  const std::unique_ptr<void, void (*)(void*)> nothing(operation.out->make(),
                                                       operation.out->destroy);
  encode_result(message, id, operation, nothing.get());
  wire::append_trailer(message, wire::ReplyTrailer{{}, {}, wire::StreamPart::End, position});
}

}  // namespace skein::rpc
