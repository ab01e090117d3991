#include "reply_encoding.hpp"

#include <memory>

#include "common.hpp"
#include "dds/port/sample_format.hpp"
#include "idl/encode_value.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

using wire::RequestId;

void encode_result(Bytes& message, Representation representation, const RequestId& id,
                   const OperationInfo& operation, const void* out) {
  wire::begin_reply(message, id, wire::RemoteException::Ok, operation.hash, representation);
  wire::append_discriminator(message, 0);
  idl::encode_value(*operation.out, out, message);
  dds::check_size(message.size(), "it");
}

// Declared: see call_servant().
void encode_exception(Bytes& message, Representation representation, const RequestId& id,
                      const OperationInfo& operation, const UserException& exception) {
  wire::begin_reply(message, id, wire::RemoteException::Ok, operation.hash, representation);
  wire::append_discriminator(message, exception.info().hash);
  exception.info().type->encode(exception.value(), message);
}

void encode_failure(Bytes& message, Representation representation, const RequestId& id,
                    const OperationInfo& operation, const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const UserException& exception) {
    encode_exception(message, representation, id, operation, exception);
  } catch (const Error& error) {
    encode_error(message, representation, id, error.code(), error.what());
  }
}

std::string cannot_be_sent(const std::string& what, const OperationInfo& operation,
                           const std::exception& reason) {
  return what + " of " + quoted(operation) + " cannot be sent: " + reason.what();
}

}  // namespace

void encode_error(Bytes& message, Representation representation, const RequestId& id,
                  ErrorCode code, const std::string& text, std::uint32_t operation) {
  wire::begin_reply(message, id, wire::remote_exception_of(code), operation, representation);
  wire::append_default_branch(message);
  wire::append_trailer(message, wire::ReplyTrailer{code, text});
}

void encode_outcome(Bytes& message, Representation representation, const RequestId& id,
                    const OperationInfo& operation, const void* out,
                    const std::exception_ptr& error) {
  try {
    if (error) return encode_failure(message, representation, id, operation, error);
    encode_result(message, representation, id, operation, out);
  } catch (const std::exception& reason) {
    encode_error(message, representation, id, ErrorCode::Internal,
                 cannot_be_sent(error ? "the exception" : "the result", operation, reason));
  }
}

void encode_item(Bytes& message, Representation representation, const RequestId& id,
                 const OperationInfo& operation, const void* out, std::uint64_t position) {
  try {
    encode_result(message, representation, id, operation, out);
  } catch (const std::exception& reason) {
    throw Internal(cannot_be_sent("a result", operation, reason));
  }
  wire::append_trailer(message, wire::ReplyTrailer{{}, {}, wire::StreamPart::Item, position});
}

void encode_end(Bytes& message, Representation representation, const RequestId& id,
                const OperationInfo& operation, std::uint64_t position) {
  const std::unique_ptr<void, void (*)(void*)> nothing(operation.out->make(),
                                                       operation.out->destroy);
  encode_result(message, representation, id, operation, nothing.get());
  wire::append_trailer(message, wire::ReplyTrailer{{}, {}, wire::StreamPart::End, position});
}

}  // namespace skein::rpc
