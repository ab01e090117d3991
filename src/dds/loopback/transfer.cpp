#include "../sample_format.hpp"
#include "hub.hpp"

namespace skein::dds::loopback {
namespace {

class Owner final : public SampleOwner {
 public:
  explicit Owner(const MessagePtr& message) : message_(message) {}
  std::shared_ptr<const void> keep() override { return message_; }

 private:
  const MessagePtr& message_;
};

}  // namespace

void Hub::write(WriterCore& writer, std::span<const std::byte> cdr, const KeyHash& key,
                InstanceState state) {
  const auto message = make_shared_in_call_memory<Message>(
      Message{{cdr.begin(), cdr.end(), &call_memory()}, key, state, writer.guid, source_time(), 0});
  Lock lock(mutex_);
  wait_for_room(writer, lock);
  message->sequence = ++writer.last_sequence;
  if (const auto core = writers_.find(writer.guid); core != writers_.end()) {
    watch_deadline(core->second, key, state);
  }
  if (writer.qos.transient_local) {
    if (state == InstanceState::Disposed)
      writer.history.erase(key);
    else
      writer.history.push(key, message);
  }
  for (auto link = links_.lower_bound({writer.guid, Guid{}});
       link != links_.end() && link->first.first == writer.guid; ++link) {
    if (link->second.writer_side) enqueue(link->second, message);
  }
  run_callbacks(lock);
}

bool Hub::has_room(const WriterCore& writer) const {
  const Qos& qos = writer.qos;
  if (!qos.reliable || qos.history_depth || qos.max_samples == 0) return true;
  std::set<std::uint64_t> waiting;
  for (auto link = links_.lower_bound({writer.guid, Guid{}});
       link != links_.end() && link->first.first == writer.guid; ++link) {
    for (const auto& [sequence, entry] : link->second.pending) waiting.insert(sequence);
  }
  return waiting.size() < qos.max_samples;
}

void Hub::wait_for_room(WriterCore& writer, Lock& lock) {
  if (has_room(writer)) return;
  const auto waited = may_wait_ ? writer.qos.max_blocking : std::chrono::milliseconds(0);
  if (changed_.wait_for(lock, waited, [&] { return has_room(writer); })) return;
  throw Overloaded("topic '" + writer.topic.name + "': " + std::to_string(writer.qos.max_samples) +
                   " samples wait for a reader's acknowledgment, and none was given within " +
                   std::to_string(waited.count()) + " ms");
}

bool Hub::wait_for_acknowledgments(const WriterCore& writer, std::chrono::milliseconds timeout) {
  Lock lock(mutex_);
  const auto all_arrived = [&] {
    for (const auto& [id, link] : links_) {
      if (id.first == writer.guid && !link.pending.empty()) return false;
    }
    return true;
  };
  return changed_.wait_for(lock, may_wait_ ? timeout : std::chrono::milliseconds(0), all_arrived);
}

void Hub::enqueue(Link& link, const MessagePtr& message) {
  if (reliable(link)) {
    const auto depth = link.writer->qos.history_depth;
    if (depth) {  // a newer sample of the instance takes the oldest one's place
      std::size_t same = 0;
      for (auto entry = link.pending.rbegin(); entry != link.pending.rend(); ++entry) {
        if (entry->second.message->key == message->key && ++same == *depth) {
          link.pending.erase(entry->first);
          break;
        }
      }
    }
    link.pending.try_emplace(message->sequence, Unacknowledged{message});
  }
  send(link, message, 1);
}

void Hub::send(Link& link, const MessagePtr& message, std::uint32_t attempt) {
  const LinkId id{link.writer->guid, link.reader->guid};
  const bool reachable = connected(*link.writer->participant, *link.reader->participant) &&
                         !link.writer->participant->paused && !link.reader->participant->paused;
  Fate fate = Fate::drop();
  if (reachable) {
    fate = judge_ ? judge_({id.first, id.second, link.writer->topic.name, message->sequence,
                            attempt, message->cdr.size(), message->state})
                  : Fate::deliver();
  }
  if (const auto entry = link.pending.find(message->sequence); entry != link.pending.end()) {
    entry->second.attempts = attempt;
    if (fate.delay > Duration::zero()) entry->second.in_flight += fate.copies;
  }
  if (fate.copies == 0 && reliable(link) && reachable) repeat_later(link);
  for (std::uint32_t copy = 0; copy < fate.copies; ++copy) {
    if (fate.delay > Duration::zero()) {
      after(fate.delay, [id, message](Hub& hub) { hub.arrive(id, message); });
    } else {
      arrive(id, message);
    }
  }
}

void Hub::arrive(const LinkId& id, const MessagePtr& message) {
  const auto found = links_.find(id);
  if (found == links_.end()) return;
  Link& link = found->second;
  const auto entry = link.pending.find(message->sequence);
  if (entry != link.pending.end() && entry->second.in_flight > 0) --entry->second.in_flight;
  const bool reachable = connected(*link.writer->participant, *link.reader->participant) &&
                         !link.reader->participant->paused;
  if (!link.reader_side || !reachable) {
    if (reachable && reliable(link) && link.writer_side) repeat_later(link);
    return;
  }
  if (!reliable(link)) {
    if (message->sequence > link.delivered) {
      accept(link, message);
      link.delivered = message->sequence;
    }
  } else if (entry != link.pending.end()) {
    entry->second.arrived = true;
    deliver_in_order(link);
  }
}

void Hub::deliver_in_order(Link& link) {
  while (!link.pending.empty() && link.pending.begin()->second.arrived) {
    const auto first = link.pending.begin();
    if (first->first > link.delivered) {
      accept(link, first->second.message);
      link.delivered = first->first;
    }
    link.pending.erase(first);
  }
  changed_.notify_all();
}

void Hub::accept(const Link& link, const MessagePtr& message) {
  ReaderCore& reader = *link.reader;
  if (message->state == InstanceState::Alive && !is_plain_cdr(message->cdr)) {
    ++reader.malformed;
    return;
  }
  const Qos& offered = link.writer->qos;
  const auto expiry =
      reader.gate.admit(message->key, message->writer, {offered.strength, offered.lifespan},
                        message->written, source_time());
  if (!expiry) return;
  watch_deadline(link.reader, message->key, message->state);
  if (reader.queue.push(message->key, {message, *expiry})) ++reader.replaced;
  if (reader.told) return;
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

void Hub::repeat_later(Link& link) {
  if (link.repeating) return;
  link.repeating = true;
  after(LoopbackNetwork::kRepeatAfter,
        [id = LinkId{link.writer->guid, link.reader->guid}](Hub& hub) {
          const auto found = hub.links_.find(id);
          if (found == hub.links_.end()) return;
          found->second.repeating = false;
          hub.repeat_lost(found->second);
        });
}

void Hub::repeat_lost(Link& link) {
  std::vector<Unacknowledged> lost;
  for (const auto& [sequence, entry] : link.pending) {
    if (!entry.arrived && entry.in_flight == 0) lost.push_back(entry);
  }
  for (const Unacknowledged& entry : lost) send(link, entry.message, entry.attempts + 1);
}

void Hub::repeat_between(const ParticipantCore& one, const ParticipantCore& other) {
  for (auto& [id, link] : links_) {
    const ParticipantCore* writing = link.writer->participant.get();
    const ParticipantCore* reading = link.reader->participant.get();
    if ((writing == &one && reading == &other) || (writing == &other && reading == &one)) {
      repeat_lost(link);
    }
  }
}

std::size_t Hub::take(ReaderCore& reader, const std::function<void(const Sample&)>& consumer,
                      std::size_t limit) {
  std::pmr::vector<MessagePtr> taken{&call_memory()};
  {
    Lock lock(mutex_);
    while (taken.size() < limit) {
      auto arrived = reader.queue.pop();
      if (!arrived) break;
      if (!reader.gate.fresh(arrived->expiry, source_time())) continue;
      taken.push_back(std::move(arrived->message));
    }
  }
  for (const MessagePtr& message : taken) {
    Owner owner(message);
    consumer({message->cdr, message->state, message->key, message->writer, &owner});
  }
  return taken.size();
}

std::uint64_t Hub::malformed(const ReaderCore& reader) {
  Lock lock(mutex_);
  return reader.malformed;
}

}  // namespace skein::dds::loopback
