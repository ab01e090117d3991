#include "hub.hpp"

namespace skein::dds::loopback {

bool Hub::connected(const ParticipantCore& one, const ParticipantCore& other) const {
  if (&one == &other) return true;
  if (one.options.domain != other.options.domain || one.killed || other.killed) return false;
  return !isolated_.contains(one.guid) && !isolated_.contains(other.guid) &&
         !separated_.contains(std::minmax(one.guid, other.guid));
}

/// Follows every change of who can hear whom. A paused observer notices nothing until it resumes.
void Hub::update_presence() {
  for (const auto& [observer_guid, observer] : participants_) {
    if (observer->paused || observer->killed) continue;
    for (const auto& [observed_guid, observed] : participants_) {
      if (observer == observed || observer->options.domain != observed->options.domain) continue;
      View& view = observer->views[observed_guid];
      const bool heard = connected(*observer, *observed) && !observed->paused;
      if (heard && !view.heard) hear(*observer, observed, view);
      if (!heard && view.heard) lose_sound(*observer, *observed, view);
    }
  }
}

void Hub::hear(ParticipantCore& observer, const std::shared_ptr<ParticipantCore>& observed,
               View& view) {
  view.heard = true;
  ++view.generation;
  if (!view.known) {
    view.known = true;
    tell_presence(observer, observed->guid, true);
    match_all(observer, *observed);
  }
  for (auto& [id, match] : matches_) {
    if (match.alive || match.writer->participant != observed) continue;
    if (match.reader->participant.get() != &observer) continue;
    match.alive = true;
    post(match.reader.get(), [reader = match.reader, writer = id.first] {
      if (reader->listener.on_liveliness) reader->listener.on_liveliness(writer, true);
    });
  }
  repeat_between(observer, *observed);
}

void Hub::lose_sound(ParticipantCore& observer, ParticipantCore& observed, View& view) {
  view.heard = false;
  const std::uint64_t generation = ++view.generation;
  for (const auto& [id, match] : matches_) {
    if (!match.reader_side || !match.reader->qos.liveliness_lease) continue;
    if (match.writer->participant.get() != &observed) continue;
    if (match.reader->participant.get() != &observer) continue;
    after(*match.reader->qos.liveliness_lease,
          [id = id, generation](Hub& hub) { hub.expire_liveliness(id, generation); });
  }
  after(observed.options.lease,
        [observer = observer.guid, observed = observed.guid, generation](Hub& hub) {
          hub.expire_participant(observer, observed, generation);
        });
}

bool Hub::still_silent(const Guid& observer, const Guid& observed, std::uint64_t generation) {
  const auto found = participants_.find(observer);
  if (found == participants_.end() || found->second->killed) return false;
  ParticipantCore& participant = *found->second;
  const auto view = participant.views.find(observed);
  if (view == participant.views.end() || view->second.generation != generation) return false;
  // Who is paused when the lease expires counts the silence anew when it resumes.
  if (participant.paused) view->second.heard = true;
  return !participant.paused;
}

void Hub::expire_participant(const Guid& observer, const Guid& observed, std::uint64_t generation) {
  if (!still_silent(observer, observed, generation)) return;
  forget(*participants_.at(observer), observed);
}

void Hub::expire_liveliness(const MatchId& id, std::uint64_t generation) {
  const auto found = matches_.find(id);
  if (found == matches_.end() || !found->second.reader_side || !found->second.alive) return;
  Match& match = found->second;
  if (!still_silent(match.reader->participant->guid, match.writer->participant->guid, generation)) {
    return;
  }
  match.alive = false;
  match.reader->queue.writer_not_alive(id.first);
  post(match.reader.get(), [reader = match.reader, writer = id.first] {
    if (reader->listener.on_liveliness) reader->listener.on_liveliness(writer, false);
  });
}

/// The observer drops all that it knows of the observed.
void Hub::forget(ParticipantCore& observer, const Guid& observed) {
  View& view = observer.views[observed];
  if (!view.known) return;
  for (auto& [id, match] : matches_) {
    const Guid& writing = match.writer->participant->guid;
    const Guid& reading = match.reader->participant->guid;
    if (writing == observed && reading == observer.guid) unmatch_reader_side(match);
    if (reading == observed && writing == observer.guid) unmatch_writer_side(match);
  }
  drop_unused_links();
  view.known = false;
  tell_presence(observer, observed, false);
}

void Hub::tell_presence(ParticipantCore& observer, const Guid& observed, bool present) {
  if (!observer.options.on_participant) return;
  callbacks_.push_back({&observer, [tell = observer.options.on_participant, observed, present] {
                          tell(observed, present);
                        }});
}

}  // namespace skein::dds::loopback
