#include "recording/perfetto_trace.hpp"

#include <algorithm>

#include "core/whole_file.hpp"
#include "recording/protobuf_writer.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"

namespace skein::recording {
namespace {

using introspection::CallEvent, introspection::CallEvents, introspection::CallStep,
    introspection::Decision;

constexpr const char* kCallsTopic = "skein/calls";
constexpr const char* kDecisionsTopic = "skein/decisions";

bool is_beginning(CallStep step) { return step == CallStep::Sent || step == CallStep::Received; }

bool is_at_provider(CallStep step) {
  return step == CallStep::Received || step == CallStep::Replied || step == CallStep::RepliedError;
}

/// FNV-1a of a connection and a call's number.
std::uint64_t flow_of(const CallEvent& event) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](std::uint8_t byte) { hash = (hash ^ byte) * 0x100000001b3; };
  for (const std::uint8_t byte : event.client) add(byte);
  for (unsigned i = 0; i < sizeof event.number; ++i) add(event.number >> 8 * i & 0xFF);
  return hash;
}

std::uint64_t positive(std::int64_t duration) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(duration, 0));
}

}  // namespace

void PerfettoTrace::add(const CallEvent& event) {
  see(event.time);
  const bool at_provider = is_at_provider(event.step);
  const CallKey key(event.client, event.number, at_provider, event.entity, event.service,
                    event.operation);
  if (is_beginning(event.step)) {
    Slice slice{.begin = event.time, .name = event.service + "." + event.operation};
    // Older recordings have no number where a call stayed within its process.
    if (event.number != 0) slice.flow = flow_of(event);
    auto& slices = slices_[event.entity][at_provider ? "provides" : "calls"];
    open_[key].push_back(&slices.emplace_back(std::move(slice)));
    return;
  }
  const auto found = open_.find(key);
  if (found == open_.end()) return;
  Slice& slice = *found->second.front();
  slice.end = std::max(event.time, slice.begin);
  if (!event.error.empty()) slice.details["error"] = event.error;
  found->second.pop_front();
  if (found->second.empty()) open_.erase(found);
}

void PerfettoTrace::add(const Decision& decision) {
  Slice slice{.begin = decision.time,
              .end = decision.time + positive(decision.took),
              .name = "decide " + decision.service};
  see(*slice.end);
  slice.details = {{"request", decision.request},
                   {"strategy", decision.strategy},
                   {"execution", decision.execution},
                   {"synthesis", decision.synthesis},
                   {"failure", decision.failure}};
  std::erase_if(slice.details, [](const auto& detail) { return detail.second.empty(); });
  for (const introspection::Attempt& attempt : decision.attempts) {
    const std::uint64_t begin = std::min(decision.time + positive(attempt.began), *slice.end);
    Slice inner{.begin = begin,
                .end = std::min(begin + positive(attempt.took), *slice.end),
                .name = attempt.csp};
    inner.details = {{"outcome", to_string(attempt.outcome)}, {"reason", attempt.reason}};
    if (!attempt.text.empty()) inner.details["text"] = attempt.text;
    if (!attempt.check.empty()) inner.details["check"] = attempt.check;
    slice.inner.push_back(std::move(inner));
  }
  std::ranges::stable_sort(slice.inner, {}, &Slice::begin);
  slices_[decision.entity]["decides"].push_back(std::move(slice));
}

/// A track, and until when it is taken.
struct PerfettoTrace::Lane {
  std::uint64_t track;
  std::uint64_t end;
};

/// The messages of perfetto.protos.Trace.
class PerfettoTrace::Writer {
 public:
  explicit Writer(std::uint64_t last) : last_(last) {}

  void begin_process(const std::string& name) {
    process_ = ++tracks_;
    ProtobufWriter process;
    process.number(kPid, process_);
    process.text(kProcessName, name);
    ProtobufWriter descriptor;
    descriptor.number(kUuid, process_);
    descriptor.message(kProcess, process);
    describe(descriptor);
  }

  void write(const std::string& kind, std::deque<Slice> slices) {
    std::ranges::stable_sort(slices, {}, &Slice::begin);
    std::vector<Lane> lanes;
    for (const Slice& slice : slices) {
      const std::size_t lane = free_lane(lanes, kind, slice.begin);
      lanes[lane].end = slice.end.value_or(last_);
      begin(lanes[lane].track, kind, slice);
      std::uint64_t inner_end = slice.begin;
      for (const Slice& inner : slice.inner) {
        const bool fits = inner.begin >= inner_end;
        const std::size_t place = fits ? lane : free_lane(lanes, kind, inner.begin);
        auto& place_end = fits ? inner_end : lanes[place].end;
        place_end = inner.end.value_or(last_);
        begin(lanes[place].track, kind, inner);
        end(lanes[place].track, inner);
      }
      end(lanes[lane].track, slice);
    }
  }

  const std::string& bytes() const { return trace_.bytes(); }

 private:
  // Numbers of fields.
  static constexpr unsigned kPacket = 1;
  static constexpr unsigned kTimestamp = 8, kSequence = 10, kTrackEvent = 11, kSequenceFlags = 13,
                            kTrackDescriptor = 60;
  static constexpr unsigned kUuid = 1, kName = 2, kProcess = 3, kParent = 5;
  static constexpr unsigned kPid = 1, kProcessName = 6;
  static constexpr unsigned kDetail = 4, kType = 9, kTrack = 11, kCategory = 22, kEventName = 23,
                            kFlow = 47;
  static constexpr unsigned kDetailText = 6, kDetailName = 10;
  static constexpr std::uint64_t kSliceBegin = 1, kSliceEnd = 2;

  std::size_t free_lane(std::vector<Lane>& lanes, const std::string& kind, std::uint64_t from) {
    const auto found =
        std::ranges::find_if(lanes, [from](const Lane& lane) { return lane.end <= from; });
    if (found != lanes.end()) return static_cast<std::size_t>(found - lanes.begin());
    lanes.push_back({++tracks_, 0});
    ProtobufWriter descriptor;
    descriptor.number(kUuid, tracks_);
    descriptor.number(kParent, process_);
    descriptor.text(kName, kind);
    describe(descriptor);
    return lanes.size() - 1;
  }

  void describe(const ProtobufWriter& descriptor) {
    ProtobufWriter packet;
    packet.message(kTrackDescriptor, descriptor);
    add(packet);
  }

  void begin(std::uint64_t track, const std::string& kind, const Slice& slice) {
    ProtobufWriter event;
    event.number(kType, kSliceBegin);
    event.number(kTrack, track);
    event.text(kCategory, kind);
    event.text(kEventName, slice.name);
    if (slice.flow) event.fixed(kFlow, *slice.flow);
    for (const auto& [name, text] : slice.details) {
      ProtobufWriter detail;
      detail.text(kDetailName, name);
      detail.text(kDetailText, text);
      event.message(kDetail, detail);
    }
    add_event(slice.begin, event);
  }

  void end(std::uint64_t track, const Slice& slice) {
    ProtobufWriter event;
    event.number(kType, kSliceEnd);
    event.number(kTrack, track);
    add_event(slice.end.value_or(last_), event);
  }

  void add_event(std::uint64_t time, const ProtobufWriter& event) {
    ProtobufWriter packet;
    packet.number(kTimestamp, time);
    packet.message(kTrackEvent, event);
    add(packet);
  }

  void add(ProtobufWriter& packet) {
    packet.number(kSequence, 1);
    // The first packet says that nothing was said before.
    if (trace_.bytes().empty()) packet.number(kSequenceFlags, 1);
    trace_.message(kPacket, packet);
  }

  const std::uint64_t last_;
  ProtobufWriter trace_;
  std::uint64_t tracks_ = 0;
  std::uint64_t process_ = 0;
};

std::string PerfettoTrace::finish() {
  Writer writer(last_);
  for (const auto& [entity, kinds] : slices_) {
    writer.begin_process(entity);
    for (const auto& [kind, slices] : kinds) writer.write(kind, slices);
  }
  return writer.bytes();
}

PerfettoExport export_to_perfetto(const Reader& recording, const std::string& path) {
  Selection selection;
  for (const auto& [id, channel] : recording.channels()) {
    if (channel.topic == kCallsTopic || channel.topic == kDecisionsTopic) {
      selection.topics.push_back(channel.topic);
    }
  }
  if (selection.topics.empty()) {
    throw InvalidArgument(std::string("the recording has neither ") + kCallsTopic + " nor " +
                          kDecisionsTopic + "; record these topics to have a trace");
  }
  write_output([&] { try_whole_file("the trace", path); });
  PerfettoTrace trace;
  PerfettoExport done;
  auto messages = recording.messages(selection);
  while (const auto message = messages.next()) {
    try {
      if (recording.channels().at(message->channel).topic == kCallsTopic) {
        const auto batch = idl::decode_message<CallEvents>(message->data);
        for (const CallEvent& event : batch.values) trace.add(event);
        done.events += batch.values.size();
      } else {
        trace.add(idl::decode_message<Decision>(message->data));
        ++done.decisions;
      }
    } catch (const idl::MalformedSample&) {
      ++done.malformed;
    }
  }
  write_output([&] { write_whole_file("the trace", path, trace.finish()); });
  return done;
}

}  // namespace skein::recording
