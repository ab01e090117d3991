#include "rpc/service/call_recorder.hpp"

#include <utility>

#include "core/wall_clock.hpp"
#include "rpc/wire/common.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"

namespace skein::introspection {

std::size_t size_of(const CallRecord& record) {
  return sizeof record + record.entity.size() + record.service.size() + record.operation.size() +
         record.arguments.size() + record.result.size() + record.text.size();
}

}  // namespace skein::introspection

namespace skein::rpc {
namespace {

using introspection::CallEnd;
using introspection::CallRecord;

/// A message of its own; empty for what CDR cannot carry.
std::vector<std::uint8_t> message_of(const TypeSupport& type, const void* value) {
  thread_local Bytes message;  // keeps its room, which is found by trial
  message.clear();
  message.append(encapsulation(type.representation));
  try {
    type.encode(value, message);
  } catch (const InvalidArgument&) {
    return {};
  }
  const auto* first = reinterpret_cast<const std::uint8_t*>(message.data());
  std::vector<std::uint8_t> octets(first, first + message.size());
  if (message.capacity() > kKeptCapacity) message = Bytes();
  return octets;
}

}  // namespace

/// Records the results of a stream before they go on.
class CallRecorder::Tap::Items final : public StreamWriter {
 public:
  Items(Tap& tap, StreamWriter& next) : tap_(tap), next_(next) {}

  bool put(const void* out, bool wait) override {
    if (!next_.put(out, wait)) return false;
    CallRecord record = tap_.record(CallEnd::Item);
    record.position = position_++;
    record.result = message_of(*tap_.operation_.out, out);
    tap_.recorder_->publisher_.publish(std::move(record));
    return true;
  }

 private:
  Tap& tap_;
  StreamWriter& next_;
  std::uint64_t position_ = 0;
};

CallRecorder::CallRecorder(dds::Participant& participant, Clock& clock, Executor& control,
                           std::string entity)
    : entity_(std::move(entity)),
      publisher_(participant, clock, control, introspection::kTopic<introspection::CallRecords>) {}

CallRecorder::Tap::Tap(CallRecorder* recorder, const InterfaceInfo& interface,
                       const OperationInfo& operation, const wire::RequestId& id, const void* in)
    : recorder_(recorder && recorder->publisher_.on() ? recorder : nullptr),
      interface_(interface),
      operation_(operation),
      id_(id) {
  if (!recorder_) return;
  begun_ = nanoseconds_since_1970();
  begun_steadily_ = std::chrono::steady_clock::now();
  arguments_ = message_of(*operation.in, in);
}

void* CallRecorder::Tap::passing(void* out) {
  if (!recorder_ || !operation_.stream) return out;
  items_ = std::make_shared<Items>(*this, *static_cast<StreamWriter*>(out));
  return items_.get();
}

CallRecord CallRecorder::Tap::record(CallEnd end) {
  CallRecord record;
  record.client = id_.client.bytes;
  record.number = id_.number;
  record.entity = recorder_->entity_;
  record.service = interface_.name;
  record.operation = operation_.name;
  record.begun = begun_;
  const std::chrono::nanoseconds took = std::chrono::steady_clock::now() - begun_steadily_;
  record.ended = begun_ + static_cast<std::uint64_t>(took.count());
  record.end = end;
  if (end != CallEnd::Item) record.arguments = std::move(arguments_);
  return record;
}

void CallRecorder::Tap::returned(const void* out) {
  if (!recorder_) return;
  CallRecord ended = record(CallEnd::Returned);
  if (!operation_.stream) ended.result = message_of(*operation_.out, out);
  recorder_->publisher_.publish(std::move(ended));
}

void CallRecorder::Tap::raised(const UserException& exception) {
  if (!recorder_) return;
  CallRecord ended = record(CallEnd::Raised);
  ended.result = message_of(*exception.info().type, exception.value());
  ended.text = exception.info().name;
  recorder_->publisher_.publish(std::move(ended));
}

void CallRecorder::Tap::failed(const std::exception& error) {
  if (!recorder_) return;
  CallRecord ended = record(CallEnd::Broken);
  ended.text = error.what();
  recorder_->publisher_.publish(std::move(ended));
}

}  // namespace skein::rpc
