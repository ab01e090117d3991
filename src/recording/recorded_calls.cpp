#include "recording/recorded_calls.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/log.hpp"
#include "core/system/interface_name.hpp"
#include "idl/types/parameter_struct.hpp"
#include "rpc/service/call_recorder.hpp"
#include "skein/describe.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"

namespace skein::recording {
namespace {

using introspection::CallEnd;
using introspection::CallRecord;
using introspection::CallRecords;

constexpr std::uint16_t kNoChannel = std::numeric_limits<std::uint16_t>::max();
constexpr const char* kRequest = "request";
constexpr const char* kReply = "reply";

std::string part_of_result(const CallRecord& record) {
  return record.end == CallEnd::Raised ? "raised/" + record.text : kReply;
}

/// How long ago a call ended, by the entity's wall clock and by this machine's: nothing if these
/// differ by more than a record is on its way.
std::uint64_t age_of(const CallRecord& record, std::uint64_t now) {
  constexpr std::uint64_t kLongestWay = 1'000'000'000;
  const std::uint64_t age = now - record.ended;
  return age <= kLongestWay ? age : 0;
}

/// The operation, and the interface that declares it; nothing if they are not described.
std::pair<const types::Interface*, const types::Operation*> find_operation(
    const types::TypeSystem& known, const std::string& name) {
  for (const types::Interface& interface : known.interfaces) {
    const auto found = std::ranges::find(interface.operations, name, &types::Operation::name);
    if (found != interface.operations.end()) return {&interface, &*found};
  }
  return {};
}

/// The type of a part, which is added to `known` where generated code alone has it.
std::string add_type(types::TypeSystem& known, const CallRecord& record, const std::string& part) {
  if (part != kRequest && part != kReply) {
    const auto raised =
        std::ranges::find(known.declarations, record.text, &types::Declaration::name);
    if (raised == known.declarations.end()) {
      throw InvalidArgument("the exception " + record.text + " is not described");
    }
    raised->kind = types::DeclarationKind::Struct;  // it is as such on the wire
    return record.text;
  }
  const auto [interface, operation] = find_operation(known, record.operation);
  if (!operation) throw InvalidArgument("the operation " + record.operation + " is not described");
  known.declarations.push_back(part == kRequest ? idl::in_struct(*interface, *operation)
                                                : idl::out_struct(*interface, *operation));
  return known.declarations.back().name;
}

}  // namespace

RecordedCalls::RecordedCalls(Writer& writer, RecordedTypes& types, const RecordingTime& time,
                             AskTypes ask, std::size_t most_waiting)
    : writer_(writer),
      types_(types),
      time_(time),
      ask_(std::move(ask)),
      most_waiting_(most_waiting) {
  const std::string type = "skein::introspection::CallRecord";
  records_ = types_.add_channel(introspection::kTopic<CallRecords>.name, type,
                                skein::describe(idl::type_support<CallRecord>()),
                                {{"type", type}, {"introspection", "true"}});
}

void RecordedCalls::receive(const dds::Sample& sample) {
  if (sample.state != dds::InstanceState::Alive) return;
  auto batch = introspection::decoded<CallRecords>(sample);
  const ClockTimes now = clock_times_now();
  std::lock_guard lock(mutex_);
  count_dropped(sample.writer, batch.dropped);
  for (const CallRecord& record : batch.values)
    receive({record, ++sequence_, sample.writer.participant(),
             time_.at(now.since_boot) - age_of(record, now.wall)});
}

// Under the lock. What an entity had dropped before it was recorded does not count.
void RecordedCalls::count_dropped(const Guid& writer, std::uint64_t dropped) {
  const auto [known, is_new] = dropped_.try_emplace(writer, dropped);
  if (!is_new && dropped > known->second) {
    writer_.count_dropped(records_, dropped - known->second);
    known->second = dropped;
  }
}

// Under the lock.
void RecordedCalls::receive(Waiting waiting) {
  const CallRecord& record = waiting.record;
  const bool known = channels_.contains({record.service, record.operation, kRequest}) &&
                     channels_.contains({record.service, record.operation, part_of_result(record)});
  const std::size_t size = sizeof waiting + introspection::size_of(record);
  if (known) return write(waiting);
  if (waiting_size_ > 0 && waiting_size_ + size > most_waiting_) {
    writer_.count_dropped(records_, 1);
    return;
  }
  waiting_size_ += size;
  waiting_.push_back(std::move(waiting));
}

void RecordedCalls::name_channels() {
  std::vector<Waiting> waiting;
  {
    std::lock_guard lock(mutex_);
    waiting.swap(waiting_);
    waiting_size_ = 0;
  }
  for (const Waiting& each : waiting) {
    for (const std::string& part : {std::string(kRequest), part_of_result(each.record)}) {
      const std::uint16_t channel = channel_of(each, part);
      std::lock_guard lock(mutex_);
      if (channel == kNoChannel) continue;
      channels_.try_emplace({each.record.service, each.record.operation, part}, channel);
    }
    std::lock_guard lock(mutex_);
    write(each);
  }
}

// Not under the lock: it asks.
std::uint16_t RecordedCalls::channel_of(const Waiting& waiting, const std::string& part) {
  const CallRecord& record = waiting.record;
  {
    std::lock_guard lock(mutex_);
    const auto known = channels_.find({record.service, record.operation, part});
    if (known != channels_.end()) return known->second;
    if (channels_.size() >= kMostChannels) return kNoChannel;
  }
  const std::string topic = "calls/" + record.service + "/" + record.operation + "/" + part;
  std::map<std::string, std::string> metadata{{"service", record.service},
                                              {"operation", record.operation}};
  try {
    types::TypeSystem known = types_of(waiting);
    const std::string type = add_type(known, record, part);
    metadata["type"] = type;
    return types_.add_channel(topic, type, known, metadata);
  } catch (const Error& error) {
    log(LogLevel::Warning, "recording", topic + " has no schema: " + error.what());
    return writer_.add_channel(topic, 0, std::move(metadata));
  }
}

// A participant that does not answer once is not asked again, whatever services it has: each
// silence takes time from the others.
const types::TypeSystem& RecordedCalls::types_of(const Waiting& waiting) {
  const std::string& service = waiting.record.service;
  const auto known = told_.find({service, waiting.participant});
  if (known != told_.end()) return known->second;
  if (!silent_.insert(waiting.participant).second)
    throw Unavailable("the provider of " + service + " did not tell its types");
  types::TypeSystem told = ask_(service, waiting.participant);
  silent_.erase(waiting.participant);
  return told_.emplace(std::pair(service, waiting.participant), std::move(told)).first->second;
}

// Under the lock.
void RecordedCalls::write(const Waiting& waiting) {
  const CallRecord& record = waiting.record;
  const std::uint64_t took = record.ended - std::min(record.begun, record.ended);
  const std::uint64_t begun = waiting.ended - std::min(took, waiting.ended);
  if (record.end != CallEnd::Item)
    write_part(waiting, kRequest, record.arguments, begun, record.begun);
  write_part(waiting, part_of_result(record), record.result, waiting.ended, record.ended);
  CallRecord rest = record;
  rest.arguments.clear();
  rest.result.clear();
  const Bytes message = idl::encode_message(rest);
  writer_.write({records_, waiting.sequence, waiting.ended, record.ended, message});
}

void RecordedCalls::write_part(const Waiting& waiting, const std::string& part,
                               const std::vector<std::uint8_t>& data, std::uint64_t log_time,
                               std::uint64_t publish_time) {
  const auto channel = channels_.find({waiting.record.service, waiting.record.operation, part});
  if (data.empty()) return;
  if (channel == channels_.end()) return writer_.count_dropped(records_, 1);
  writer_.write(
      {channel->second, waiting.sequence, log_time, publish_time, std::as_bytes(std::span(data))});
}

}  // namespace skein::recording
