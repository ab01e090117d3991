#include "recording/viewers/perfetto_trace.hpp"

#include <algorithm>

#include "core/system/whole_file.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/json.hpp"
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
    if (event.number != 0) {
      slice.flow = flow_of(event);
      auto& begin = flows_.try_emplace(*slice.flow, event.time).first->second;
      begin = std::min(begin, event.time);
    }
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
  see(slice.begin);
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

/// Trace events as JSON. Their times are microseconds since the first one.
class PerfettoTrace::Writer {
 public:
  explicit Writer(const PerfettoTrace& trace) : trace_(trace) {
    json_.begin_object();
    json_.key("traceEvents");
    json_.begin_array();
  }

  void begin_process(const std::string& name) {
    process_ = ++tracks_;
    describe("process_name", process_, name);
  }

  void write(const std::string& kind, std::deque<Slice> slices) {
    std::ranges::stable_sort(slices, {}, &Slice::begin);
    std::vector<Lane> lanes;
    for (const Slice& slice : slices) {
      const std::size_t lane = free_lane(lanes, kind, slice.begin);
      lanes[lane].end = slice.end.value_or(trace_.last_);
      begin(lanes[lane].track, kind, slice);
      std::uint64_t inner_end = slice.begin;
      for (const Slice& inner : slice.inner) {
        const bool fits = inner.begin >= inner_end;
        const std::size_t place = fits ? lane : free_lane(lanes, kind, inner.begin);
        auto& place_end = fits ? inner_end : lanes[place].end;
        place_end = inner.end.value_or(trace_.last_);
        begin(lanes[place].track, kind, inner);
        end(lanes[place].track, inner);
      }
      end(lanes[lane].track, slice);
    }
  }

  std::string finish() {
    json_.end_array();
    json_.end_object();
    return json_.take();
  }

 private:
  std::size_t free_lane(std::vector<Lane>& lanes, const std::string& kind, std::uint64_t from) {
    const auto found =
        std::ranges::find_if(lanes, [from](const Lane& lane) { return lane.end <= from; });
    if (found != lanes.end()) return static_cast<std::size_t>(found - lanes.begin());
    lanes.push_back({++tracks_, 0});
    describe("thread_name", tracks_, kind);
    return lanes.size() - 1;
  }

  void describe(const char* what, std::uint64_t track, const std::string& name) {
    begin_event("M", track);
    text("name", what);
    json_.key("args");
    write({{"name", name}});
    json_.end_object();
  }

  void begin(std::uint64_t track, const std::string& kind, const Slice& slice) {
    begin_event("B", track);
    time(slice.begin);
    text("cat", kind);
    text("name", slice.name);
    if (slice.flow) {  // the viewer knows no arrow that ends before it begins
      json_.key("bind_id");
      json_.write(*slice.flow);
      json_.key(slice.begin == trace_.flows_.at(*slice.flow) ? "flow_out" : "flow_in");
      json_.write(true);
    }
    json_.key("args");
    write(slice.details);
    json_.end_object();
  }

  void end(std::uint64_t track, const Slice& slice) {
    begin_event("E", track);
    time(slice.end.value_or(trace_.last_));
    json_.end_object();
  }

  void begin_event(const char* phase, std::uint64_t track) {
    json_.begin_object();
    text("ph", phase);
    json_.key("pid");
    json_.write(process_);
    json_.key("tid");
    json_.write(track);
  }

  void time(std::uint64_t time) {
    const std::uint64_t since = time - trace_.first_;
    json_.key("ts");
    json_.write_raw(std::to_string(since / 1000) + "." +
                    std::to_string(1000 + since % 1000).substr(1));
  }

  void text(std::string_view key, std::string_view value) {
    json_.key(key);
    json_.write_string(value);
  }

  void write(const std::map<std::string, std::string>& details) {
    json_.begin_object();
    for (const auto& [name, value] : details) text(name, value);
    json_.end_object();
  }

  const PerfettoTrace& trace_;
  idl::JsonWriter json_;
  std::uint64_t tracks_ = 0;
  std::uint64_t process_ = 0;
};

std::string PerfettoTrace::finish() {
  Writer writer(*this);
  for (const auto& [entity, kinds] : slices_) {
    writer.begin_process(entity);
    for (const auto& [kind, slices] : kinds) writer.write(kind, slices);
  }
  return writer.finish();
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
