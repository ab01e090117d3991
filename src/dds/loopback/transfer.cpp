#include "core/clock_wait.hpp"
#include "hub.hpp"

namespace skein::dds::loopback {
namespace {

/// What all readers of a message share.
struct MessageHolder {
  MessagePtr message;
  std::shared_ptr<const void> keep() const { return message; }
};

}  // namespace

void Hub::write(WriterCore& writer, std::span<const std::byte> cdr, const KeyHash& key,
                InstanceState state) {
  const auto message =
      make_shared_in_call_memory<Message>(Message{{cdr.begin(), cdr.end(), &call_memory()},
                                                  key,
                                                  state,
                                                  writer.guid,
                                                  clock_.now().time_since_epoch(),
                                                  0});
  Lock lock(mutex_);
  wait_for_room(writer, lock);
  message->sequence = ++writer.last_sequence;
  if (writer.deadline) {
    state == InstanceState::Alive ? writer.deadline->heard(key) : writer.deadline->ended(key);
  }
  if (writer.qos.transient_local) {
    if (state == InstanceState::Disposed)
      writer.history.erase(key);
    else
      writer.history.push(key, message);
  }
  for (auto match = matches_.lower_bound({writer.guid, Guid{}});
       match != matches_.end() && match->first.first == writer.guid; ++match) {
    if (match->second.writer_side) enqueue(match->second, message);
  }
  run_callbacks(lock);
}

bool Hub::has_room(const WriterCore& writer) const {
  const Qos& qos = writer.qos;
  if (!qos.reliable || qos.history_depth || qos.max_samples == 0) return true;
  std::set<std::uint64_t> waiting;
  for (auto match = matches_.lower_bound({writer.guid, Guid{}});
       match != matches_.end() && match->first.first == writer.guid; ++match) {
    for (const auto& [sequence, entry] : match->second.pending) waiting.insert(sequence);
  }
  return waiting.size() < qos.max_samples;
}

void Hub::wait_for_room(WriterCore& writer, Lock& lock) {
  if (has_room(writer)) return;
  const auto waited = patience(writer.qos.max_blocking);
  if (wait_until(clock_, clock_.after(waited), lock, changed_, [&] { return has_room(writer); })) {
    return;
  }
  throw Overloaded("topic '" + writer.topic.name + "': " + std::to_string(writer.qos.max_samples) +
                   " samples wait for a reader's acknowledgment, and none was given within " +
                   std::to_string(waited.count()) + " ms");
}

bool Hub::wait_for_acknowledgments(const WriterCore& writer, std::chrono::milliseconds timeout) {
  Lock lock(mutex_);
  const auto all_arrived = [&] {
    for (const auto& [id, match] : matches_) {
      if (id.first == writer.guid && !match.pending.empty()) return false;
    }
    return true;
  };
  return wait_until(clock_, clock_.after(patience(timeout)), lock, changed_, all_arrived);
}

// A listener may be called on the clock's thread, which cannot wait for itself.
std::chrono::milliseconds Hub::patience(std::chrono::milliseconds wanted) const {
  const bool listener = runner_ == std::this_thread::get_id();
  return may_wait_ && !listener ? wanted : std::chrono::milliseconds(0);
}

void Hub::enqueue(Match& match, const MessagePtr& message) {
  if (reliable(match)) {
    const auto depth = match.writer->qos.history_depth;
    if (depth) {  // a newer sample of the instance takes the oldest one's place
      std::size_t same = 0;
      for (auto entry = match.pending.rbegin(); entry != match.pending.rend(); ++entry) {
        if (entry->second.message->key == message->key && ++same == *depth) {
          match.pending.erase(entry->first);
          break;
        }
      }
    }
    match.pending.try_emplace(message->sequence, Unacknowledged{message});
  }
  send(match, message, 1);
}

void Hub::send(Match& match, const MessagePtr& message, std::uint32_t attempt) {
  const MatchId id{match.writer->guid, match.reader->guid};
  const bool reachable = connected(*match.writer->participant, *match.reader->participant) &&
                         !match.writer->participant->paused && !match.reader->participant->paused;
  Fate fate = Fate::drop();
  if (reachable) {
    fate = judge_ ? judge_({id.first, id.second, match.writer->topic.name, message->sequence,
                            attempt, message->cdr.size(), message->state})
                  : Fate::deliver();
  }
  if (const auto entry = match.pending.find(message->sequence); entry != match.pending.end()) {
    entry->second.attempts = attempt;
    if (fate.delay > Duration::zero()) entry->second.in_flight += fate.copies;
  }
  if (fate.copies == 0 && reliable(match) && reachable) repeat_later(match);
  for (std::uint32_t copy = 0; copy < fate.copies; ++copy) {
    if (fate.delay > Duration::zero()) {
      after(fate.delay, [id, message](Hub& hub) { hub.arrive(id, message); });
    } else {
      arrive(id, message);
    }
  }
}

void Hub::arrive(const MatchId& id, const MessagePtr& message) {
  const auto found = matches_.find(id);
  if (found == matches_.end()) return;
  Match& match = found->second;
  const auto entry = match.pending.find(message->sequence);
  if (entry != match.pending.end() && entry->second.in_flight > 0) --entry->second.in_flight;
  const bool reachable = connected(*match.writer->participant, *match.reader->participant) &&
                         !match.reader->participant->paused;
  if (!match.reader_side || !reachable) {
    if (reachable && reliable(match) && match.writer_side) repeat_later(match);
    return;
  }
  if (!reliable(match)) {
    if (message->sequence > match.delivered) {
      accept(match, message);
      match.delivered = message->sequence;
    }
  } else if (entry != match.pending.end()) {
    entry->second.arrived = true;
    deliver_in_order(match);
  }
}

void Hub::deliver_in_order(Match& match) {
  while (!match.pending.empty() && match.pending.begin()->second.arrived) {
    const auto first = match.pending.begin();
    if (first->first > match.delivered) {
      accept(match, first->second.message);
      match.delivered = first->first;
    }
    match.pending.erase(first);
  }
  changed_.notify_all();
}

void Hub::accept(const Match& match, const MessagePtr& message) {
  ReaderCore& reader = *match.reader;
  const Qos& offered = match.writer->qos;
  const bool stored =
      reader.queue.store({Payload(message->cdr, MessageHolder{message}), message->state,
                          message->key, message->writer, message->written},
                         {offered.strength, offered.lifespan});
  if (!stored || reader.told) return;
  reader.told = true;
  post(&reader, [this, reader = readers_.at(reader.guid)] {
    {
      Lock lock(mutex_);
      reader->told = false;
      if (reader->closed) return;
    }
    if (reader->listener.on_data) reader->listener.on_data(*reader->self);
  });
}

void Hub::repeat_later(Match& match) {
  if (match.repeating) return;
  match.repeating = true;
  after(LoopbackNetwork::kRepeatAfter,
        [id = MatchId{match.writer->guid, match.reader->guid}](Hub& hub) {
          const auto found = hub.matches_.find(id);
          if (found == hub.matches_.end()) return;
          found->second.repeating = false;
          hub.repeat_lost(found->second);
        });
}

void Hub::repeat_lost(Match& match) {
  std::vector<Unacknowledged> lost;
  for (const auto& [sequence, entry] : match.pending) {
    if (!entry.arrived && entry.in_flight == 0) lost.push_back(entry);
  }
  for (const Unacknowledged& entry : lost) send(match, entry.message, entry.attempts + 1);
}

void Hub::repeat_between(const ParticipantCore& one, const ParticipantCore& other) {
  for (auto& [id, match] : matches_) {
    const ParticipantCore* writing = match.writer->participant.get();
    const ParticipantCore* reading = match.reader->participant.get();
    if ((writing == &one && reading == &other) || (writing == &other && reading == &one)) {
      repeat_lost(match);
    }
  }
}

}  // namespace skein::dds::loopback
