#include "transfers.hpp"

namespace skein::dds::loopback {
namespace {

/// Keeps a message alive for all readers that share it.
struct MessageHolder {
  MessagePtr message;
  std::shared_ptr<const void> keep() const { return message; }
};

bool reliable(const Match& match) { return match.reader->qos.reliable; }

}  // namespace

void Transfers::write(WriterCore& writer, const std::shared_ptr<Message>& message) {
  message->sequence = ++writer.last_sequence;
  if (writer.deadline) {
    message->state == InstanceState::Alive ? writer.deadline->heard(message->key)
                                           : writer.deadline->ended(message->key);
  }
  if (writer.qos.transient_local) {
    if (message->state == InstanceState::Disposed)
      writer.history.erase(message->key);
    else
      writer.history.push(message->key, message);
  }
  for (auto match = state_.matches.lower_bound({writer.guid, Guid{}});
       match != state_.matches.end() && match->first.first == writer.guid; ++match) {
    if (match->second.writer_side) enqueue(match->second, message);
  }
}

bool Transfers::has_room(const WriterCore& writer) const {
  const Qos& qos = writer.qos;
  if (!qos.reliable || qos.history_depth || qos.max_samples == 0) return true;
  std::set<std::uint64_t> waiting;
  for (auto match = state_.matches.lower_bound({writer.guid, Guid{}});
       match != state_.matches.end() && match->first.first == writer.guid; ++match) {
    for (const auto& [sequence, entry] : match->second.pending.entries()) waiting.insert(sequence);
  }
  return waiting.size() < qos.max_samples;
}

bool Transfers::all_arrived(const WriterCore& writer) const {
  for (const auto& [id, match] : state_.matches) {
    if (id.first == writer.guid && !match.pending.entries().empty()) return false;
  }
  return true;
}

void Transfers::replay_history(Match& match) {
  if (!match.reader->qos.transient_local) return;
  std::vector<MessagePtr> missed;
  match.writer->history.for_each([&](const MessagePtr& message) {
    if (message->sequence > match.delivered) missed.push_back(message);
  });
  for (const MessagePtr& message : missed) enqueue(match, message);
}

void Transfers::give_up(Match& match) {
  match.pending.clear();
  state_.acknowledged.notify_all();
}

void Transfers::enqueue(Match& match, const MessagePtr& message) {
  if (reliable(match)) match.pending.add(message, match.writer->qos.history_depth);
  send(match, message, 1);
}

void Transfers::send(Match& match, const MessagePtr& message, std::uint32_t attempt) {
  const MatchId id{match.writer->guid, match.reader->guid};
  const ParticipantCore& from = *match.writer->participant;
  const ParticipantCore& to = *match.reader->participant;
  const bool reachable = state_.topology.connected(from, to) && !from.paused && !to.paused;
  Fate fate = Fate::drop();
  if (reachable) {
    fate = judge_ ? judge_({id.first, id.second, match.writer->topic.name, message->sequence,
                            attempt, message->cdr.size(), message->state})
                  : Fate::deliver();
  }
  const bool delayed = fate.delay > Duration::zero();
  match.pending.sent(message->sequence, attempt, delayed ? fate.copies : 0);
  if (fate.copies == 0 && reliable(match) && reachable) repeat_later(match);
  for (std::uint32_t copy = 0; copy < fate.copies; ++copy) {
    if (delayed) {
      state_.later(fate.delay, [this, id, message] { arrive(id, message); });
    } else {
      arrive(id, message);
    }
  }
}

void Transfers::arrive(const MatchId& id, const MessagePtr& message) {
  const auto found = state_.matches.find(id);
  if (found == state_.matches.end()) return;
  Match& match = found->second;
  match.pending.landed(message->sequence);
  const bool reachable =
      state_.topology.connected(*match.writer->participant, *match.reader->participant) &&
      !match.reader->participant->paused;
  if (!match.reader_side || !reachable) {
    if (reachable && reliable(match) && match.writer_side) repeat_later(match);
    return;
  }
  if (!reliable(match)) {
    accept(match, message);
  } else if (match.pending.arrived(message->sequence)) {
    while (const MessagePtr next = match.pending.pop_arrived()) accept(match, next);
    state_.acknowledged.notify_all();
  }
}

/// Drops a message that was overtaken or has been delivered.
void Transfers::accept(Match& match, const MessagePtr& message) {
  if (message->sequence <= match.delivered) return;
  ReaderCore& reader = *match.reader;
  const Qos& offered = match.writer->qos;
  const bool stored =
      reader.queue.store({Payload(message->cdr, MessageHolder{message}), message->state,
                          message->key, message->writer, message->written},
                         {offered.strength, offered.lifespan});
  match.delivered = message->sequence;
  if (!stored || reader.told) return;
  reader.told = true;
  state_.callbacks.post(
      static_cast<EndpointCore*>(&reader),
      [reader = match.reader] {
        if (reader->listener.on_data) reader->listener.on_data(*reader->self);
      },
      &reader.told);
}

void Transfers::repeat_later(Match& match) {
  if (match.repeating) return;
  match.repeating = true;
  state_.later(LoopbackNetwork::kRepeatAfter,
               [this, id = MatchId{match.writer->guid, match.reader->guid}] {
                 const auto found = state_.matches.find(id);
                 if (found == state_.matches.end()) return;
                 found->second.repeating = false;
                 repeat_lost(found->second);
               });
}

void Transfers::repeat_lost(Match& match) {
  for (const auto& entry : match.pending.lost()) send(match, entry.message, entry.attempts + 1);
}

void Transfers::repeat_between(const ParticipantCore& one, const ParticipantCore& other) {
  for (auto& [id, match] : state_.matches) {
    if (between(*match.writer, *match.reader, one, other)) repeat_lost(match);
  }
}

}  // namespace skein::dds::loopback
