#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <memory_resource>
#include <set>
#include <vector>

#include "dds/port/deadline_watch.hpp"
#include "dds/port/keyed_queue.hpp"
#include "dds/port/receive_queue.hpp"
#include "dds/port/topic_table.hpp"
#include "skein/detail/call_memory.hpp"

namespace skein::dds::loopback {

class Hub;

struct Message {
  std::pmr::vector<std::byte> cdr;
  KeyHash key;
  InstanceState state;
  Guid writer;
  SourceTime written;
  std::uint64_t sequence;
};
using MessagePtr = std::shared_ptr<const Message>;

/// The knowledge that one participant has of another.
struct View {
  bool heard = false;            // its announcements arrive
  bool known = false;            // found, and its lease has not expired
  std::uint64_t generation = 0;  // outdates the timers of earlier silences
};

struct ParticipantCore {
  Guid guid;
  ParticipantOptions options;
  bool paused = false;
  bool killed = false;
  std::atomic<std::uint32_t> last_entity{0};
  std::map<Guid, View> views;
  TopicTable<int> topics;
};

struct EndpointCore {
  Guid guid;
  std::shared_ptr<ParticipantCore> participant;
  Topic topic;
  Qos qos;
  bool closed = false;
  std::set<Guid> refused;  // peers that have been reported as incompatible
};

/// Whether one endpoint belongs to each of the two participants.
inline bool between(const EndpointCore& writer, const EndpointCore& reader,
                    const ParticipantCore& one, const ParticipantCore& other) {
  const ParticipantCore* writing = writer.participant.get();
  const ParticipantCore* reading = reader.participant.get();
  return (writing == &one && reading == &other) || (writing == &other && reading == &one);
}

/// Cores belong to one hub, which outlives them.
struct WriterCore final : EndpointCore {
  WriterCore(const Qos& qos, Hub& hub);
  WriterListener listener;
  std::uint64_t last_sequence = 0;
  KeyedQueue<MessagePtr> history;  // for late joiners, if the writer is transient-local
  const std::unique_ptr<DeadlineTimer> deadline;
};

struct ReaderCore final : EndpointCore {
  ReaderCore(const Topic& topic, const Qos& qos, Hub& hub);
  Reader* self = nullptr;
  ReaderListener listener;
  bool told = false;  // an on_data is on its way
  ReceiveQueue queue;
};

}  // namespace skein::dds::loopback
