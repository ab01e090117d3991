#include "dds/port/compatibility.hpp"
#include "hub.hpp"

namespace skein::dds::loopback {
namespace {

std::optional<Incompatibility> mismatch(const EndpointCore& writer, const EndpointCore& reader,
                                        const Guid& peer) {
  const std::string& topic = writer.topic.name;
  if (auto why = find_other_type(topic, peer, writer.topic.type_name, reader.topic.type_name)) {
    return why;
  }
  return find_incompatibility(topic, peer, writer.qos, reader.qos);
}

}  // namespace

bool Hub::knows(const ParticipantCore& observer, const ParticipantCore& observed) const {
  if (&observer == &observed) return true;
  const auto view = observer.views.find(observed.guid);
  return view != observer.views.end() && view->second.known;
}

void Hub::match(const std::shared_ptr<WriterCore>& writer,
                const std::shared_ptr<ReaderCore>& reader) {
  if (writer->topic.name != reader->topic.name || !share_partition(writer->qos, reader->qos)) {
    return;
  }
  if (mismatch(*writer, *reader, {})) {
    tell_incompatible(writer, reader);
    return;
  }
  if (writer->topic != reader->topic) return;
  const bool by_writer = knows(*writer->participant, *reader->participant);
  const bool by_reader = knows(*reader->participant, *writer->participant);
  if (!by_writer && !by_reader) return;
  Match& match =
      matches_.try_emplace({writer->guid, reader->guid}, Match{writer, reader}).first->second;
  const bool rematched = by_reader && !match.reader_side && match.writer_side;
  if (by_reader && !match.reader_side) match_reader_side(match);
  if (by_writer && !match.writer_side) {
    match_writer_side(match);
  } else if (rematched) {
    replay_history(match);
  }
}

void Hub::tell_incompatible(const std::shared_ptr<WriterCore>& writer,
                            const std::shared_ptr<ReaderCore>& reader) {
  const auto tell = [&](const auto& endpoint, const EndpointCore& peer) {
    if (!knows(*endpoint->participant, *peer.participant)) return;
    if (!endpoint->refused.insert(peer.guid).second) return;
    const auto why =
        with_other_side(*mismatch(*writer, *reader, peer.guid), peer.participant->options.name);
    post(endpoint.get(), [endpoint, why] {
      if (endpoint->listener.on_incompatible) endpoint->listener.on_incompatible(why);
    });
  };
  tell(writer, *reader);
  tell(reader, *writer);
}

void Hub::match_all(const ParticipantCore& one, const ParticipantCore& other) {
  const auto between = [&](const EndpointCore& writer, const EndpointCore& reader) {
    const ParticipantCore* writing = writer.participant.get();
    const ParticipantCore* reading = reader.participant.get();
    return (writing == &one && reading == &other) || (writing == &other && reading == &one);
  };
  for (const auto& [writer_guid, writer] : writers_) {
    for (const auto& [reader_guid, reader] : readers_) {
      if (between(*writer, *reader)) match(writer, reader);
    }
  }
}

void Hub::match_reader_side(Match& match) {
  match.reader_side = true;
  match.alive = true;
  match.delivered = match.reader->qos.transient_local ? 0 : match.writer->last_sequence;
  post(match.reader.get(), [reader = match.reader, writer = match.writer->guid] {
    if (reader->listener.on_matched) reader->listener.on_matched(writer, true);
  });
}

void Hub::match_writer_side(Match& match) {
  match.writer_side = true;
  post(match.writer.get(), [writer = match.writer, reader = match.reader->guid] {
    if (writer->listener.on_matched) writer->listener.on_matched(reader, true);
  });
  replay_history(match);
}

void Hub::replay_history(Match& match) {
  if (!match.reader->qos.transient_local) return;
  std::vector<MessagePtr> missed;
  match.writer->history.for_each([&](const MessagePtr& message) {
    if (message->sequence > match.delivered) missed.push_back(message);
  });
  for (const MessagePtr& message : missed) enqueue(match, message);
}

void Hub::unmatch_writer_side(Match& match) {
  if (!match.writer_side) return;
  match.writer_side = false;
  match.pending.clear();
  changed_.notify_all();
  if (match.writer->closed) return;
  post(match.writer.get(), [writer = match.writer, reader = match.reader->guid] {
    if (writer->listener.on_matched) writer->listener.on_matched(reader, false);
  });
}

void Hub::unmatch_reader_side(Match& match) {
  if (!match.reader_side) return;
  match.reader_side = false;
  match.reader->queue.writer_unmatched(match.writer->guid);
  if (match.reader->closed) return;
  post(match.reader.get(), [reader = match.reader, writer = match.writer->guid] {
    if (reader->listener.on_matched) reader->listener.on_matched(writer, false);
  });
}

void Hub::drop_unused_links() {
  std::erase_if(matches_, [](const auto& entry) {
    return !entry.second.writer_side && !entry.second.reader_side;
  });
}

void Hub::add(const std::shared_ptr<WriterCore>& writer) {
  Lock lock(mutex_);
  writers_.emplace(writer->guid, writer);
  for (const auto& [guid, reader] : readers_) match(writer, reader);
  run_callbacks(lock);
}

void Hub::add(const std::shared_ptr<ReaderCore>& reader) {
  Lock lock(mutex_);
  readers_.emplace(reader->guid, reader);
  for (const auto& [guid, writer] : writers_) match(writer, reader);
  run_callbacks(lock);
}

void Hub::remove(const std::shared_ptr<WriterCore>& writer) {
  Lock lock(mutex_);
  writer->closed = true;
  writers_.erase(writer->guid);
  for (auto& [id, match] : matches_) {
    if (match.writer != writer) continue;
    unmatch_writer_side(match);
    // Unreachable readers keep the match until the participant's lease expires.
    if (connected(*writer->participant, *match.reader->participant)) unmatch_reader_side(match);
  }
  drop_unused_links();
  wait_until_idle(static_cast<const EndpointCore*>(writer.get()), lock);
  run_callbacks(lock);
}

void Hub::remove(const std::shared_ptr<ReaderCore>& reader) {
  Lock lock(mutex_);
  reader->closed = true;
  readers_.erase(reader->guid);
  for (auto& [id, match] : matches_) {
    if (match.reader != reader) continue;
    unmatch_reader_side(match);
    if (connected(*reader->participant, *match.writer->participant)) unmatch_writer_side(match);
  }
  drop_unused_links();
  wait_until_idle(static_cast<const EndpointCore*>(reader.get()), lock);
  run_callbacks(lock);
}

std::vector<Guid> Hub::matched_readers(const WriterCore& writer) {
  Lock lock(mutex_);
  std::vector<Guid> readers;
  for (const auto& [id, match] : matches_) {
    if (id.first == writer.guid && match.writer_side) readers.push_back(id.second);
  }
  return readers;
}

std::vector<Guid> Hub::matched_writers(const ReaderCore& reader) {
  Lock lock(mutex_);
  std::vector<Guid> writers;
  for (const auto& [id, match] : matches_) {
    if (id.second == reader.guid && match.reader_side) writers.push_back(id.first);
  }
  return writers;
}

}  // namespace skein::dds::loopback
