#include "matching.hpp"

#include "dds/port/compatibility.hpp"

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

bool knows(const ParticipantCore& observer, const ParticipantCore& observed) {
  if (&observer == &observed) return true;
  const auto view = observer.views.find(observed.guid);
  return view != observer.views.end() && view->second.known;
}

}  // namespace

void Matching::match(const std::shared_ptr<WriterCore>& writer,
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
      state_.matches.try_emplace({writer->guid, reader->guid}, Match{writer, reader}).first->second;
  const bool rematched = by_reader && !match.reader_side && match.writer_side;
  if (by_reader && !match.reader_side) match_reader_side(match);
  if (by_writer && !match.writer_side) {
    match_writer_side(match);
  } else if (rematched) {
    transfers_.replay_history(match);
  }
}

void Matching::tell_incompatible(const std::shared_ptr<WriterCore>& writer,
                                 const std::shared_ptr<ReaderCore>& reader) {
  const auto tell = [&](const auto& endpoint, const EndpointCore& peer, auto on_incompatible) {
    if (!knows(*endpoint->participant, *peer.participant)) return;
    if (!endpoint->refused.insert(peer.guid).second) return;
    state_.callbacks.tell(
        endpoint, on_incompatible,
        with_other_side(*mismatch(*writer, *reader, peer.guid), peer.participant->options.name));
  };
  tell(writer, *reader, &WriterListener::on_incompatible);
  tell(reader, *writer, &ReaderListener::on_incompatible);
}

void Matching::match_all(const ParticipantCore& one, const ParticipantCore& other) {
  for (const auto& [writer_guid, writer] : writers_) {
    for (const auto& [reader_guid, reader] : readers_) {
      if (between(*writer, *reader, one, other)) match(writer, reader);
    }
  }
}

void Matching::unmatch_all(const ParticipantCore& observer, const Guid& observed) {
  for (auto& [id, match] : state_.matches) {
    const Guid& writing = match.writer->participant->guid;
    const Guid& reading = match.reader->participant->guid;
    if (writing == observed && reading == observer.guid) unmatch_reader_side(match);
    if (reading == observed && writing == observer.guid) unmatch_writer_side(match);
  }
  drop_unused_links();
}

void Matching::match_reader_side(Match& match) {
  match.reader_side = true;
  match.alive = true;
  match.delivered = match.reader->qos.transient_local ? 0 : match.writer->last_sequence;
  state_.callbacks.tell(match.reader, &ReaderListener::on_matched, match.writer->guid, true);
}

void Matching::match_writer_side(Match& match) {
  match.writer_side = true;
  state_.callbacks.tell(match.writer, &WriterListener::on_matched, match.reader->guid, true);
  transfers_.replay_history(match);
}

void Matching::unmatch_writer_side(Match& match) {
  if (!match.writer_side) return;
  match.writer_side = false;
  transfers_.give_up(match);
  if (match.writer->closed) return;
  state_.callbacks.tell(match.writer, &WriterListener::on_matched, match.reader->guid, false);
}

void Matching::unmatch_reader_side(Match& match) {
  if (!match.reader_side) return;
  match.reader_side = false;
  match.reader->queue.writer_unmatched(match.writer->guid);
  if (match.reader->closed) return;
  state_.callbacks.tell(match.reader, &ReaderListener::on_matched, match.writer->guid, false);
}

void Matching::drop_unused_links() {
  std::erase_if(state_.matches, [](const auto& entry) {
    return !entry.second.writer_side && !entry.second.reader_side;
  });
}

void Matching::add(const std::shared_ptr<WriterCore>& writer) {
  writers_.emplace(writer->guid, writer);
  for (const auto& [guid, reader] : readers_) match(writer, reader);
}

void Matching::add(const std::shared_ptr<ReaderCore>& reader) {
  readers_.emplace(reader->guid, reader);
  for (const auto& [guid, writer] : writers_) match(writer, reader);
}

void Matching::remove(EndpointCore& endpoint) {
  endpoint.closed = true;
  writers_.erase(endpoint.guid);
  readers_.erase(endpoint.guid);
  for (auto& [id, match] : state_.matches) {
    const bool writes = id.first == endpoint.guid;
    if (!writes && id.second != endpoint.guid) continue;
    // Unreachable ones keep the match until the participant's lease expires.
    const bool reachable =
        state_.topology.connected(*match.writer->participant, *match.reader->participant);
    if (writes || reachable) unmatch_writer_side(match);
    if (!writes || reachable) unmatch_reader_side(match);
  }
  drop_unused_links();
}

void Matching::forget_removed(const ParticipantCore& observer, const ParticipantCore& observed) {
  for (auto& [id, match] : state_.matches) {
    const ParticipantCore* const writing = match.writer->participant.get();
    const ParticipantCore* const reading = match.reader->participant.get();
    if (match.writer->closed && writing == &observed && reading == &observer)
      unmatch_reader_side(match);
    if (match.reader->closed && reading == &observed && writing == &observer)
      unmatch_writer_side(match);
  }
  drop_unused_links();
}

std::vector<Guid> Matching::matched(const Guid& endpoint) const {
  std::vector<Guid> others;
  for (const auto& [id, match] : state_.matches) {
    if (id.first == endpoint && match.writer_side) others.push_back(id.second);
    if (id.second == endpoint && match.reader_side) others.push_back(id.first);
  }
  return others;
}

void Matching::deadline_missed(const Guid& endpoint, const KeyHash& key) {
  const auto tell = [&](const auto& endpoints, auto on_deadline_missed) {
    const auto found = endpoints.find(endpoint);
    if (found != endpoints.end()) state_.callbacks.tell(found->second, on_deadline_missed, key);
  };
  tell(writers_, &WriterListener::on_deadline_missed);
  tell(readers_, &ReaderListener::on_deadline_missed);
}

}  // namespace skein::dds::loopback
