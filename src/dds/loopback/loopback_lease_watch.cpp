#include "loopback_lease_watch.hpp"

namespace skein::dds::loopback {

void LoopbackLeaseWatch::update_presence() {
  for (const auto& [observer_guid, observer] : state_.topology.participants()) {
    if (observer->paused || observer->killed) continue;
    for (const auto& [observed_guid, observed] : state_.topology.participants()) {
      if (observer == observed || observer->options.domain != observed->options.domain) continue;
      View& view = observer->views[observed_guid];
      const bool heard = state_.topology.connected(*observer, *observed) && !observed->paused;
      if (heard && !view.heard) hear(*observer, observed, view);
      if (!heard && view.heard) lose_sound(*observer, *observed, view);
    }
  }
}

void LoopbackLeaseWatch::say_goodbye(const Guid& participant) {
  for (const auto& [guid, other] : state_.topology.participants()) {
    const auto view = other->views.find(participant);
    if (view == other->views.end() || !view->second.heard) continue;
    forget(*other, participant);
    other->views.erase(view);
  }
}

void LoopbackLeaseWatch::hear(ParticipantCore& observer,
                              const std::shared_ptr<ParticipantCore>& observed, View& view) {
  view.heard = true;
  ++view.generation;
  if (!view.known) {
    view.known = true;
    tell_presence(observer, observed->guid, true);
    matching_.match_all(observer, *observed);
  }
  matching_.forget_removed(observer, *observed);
  for (auto& [id, match] : state_.matches) {
    if (match.alive || !match.reader_side || match.writer->participant != observed) continue;
    if (match.reader->participant.get() != &observer) continue;
    match.alive = true;
    state_.callbacks.tell(match.reader, &ReaderListener::on_liveliness, id.first, true);
  }
  transfers_.repeat_between(observer, *observed);
}

void LoopbackLeaseWatch::lose_sound(const ParticipantCore& observer,
                                    const ParticipantCore& observed, View& view) {
  view.heard = false;
  const std::uint64_t generation = ++view.generation;
  for (const auto& [id, match] : state_.matches) {
    if (!match.reader_side || !match.reader->qos.liveliness_lease) continue;
    if (match.writer->participant.get() != &observed) continue;
    if (match.reader->participant.get() != &observer) continue;
    state_.later(*match.reader->qos.liveliness_lease,
                 [this, id = id, generation] { expire_liveliness(id, generation); });
  }
  state_.later(observed.options.lease,
               [this, observer = observer.guid, observed = observed.guid, generation] {
                 if (!still_silent(observer, observed, generation)) return;
                 forget(*state_.topology.participants().at(observer), observed);
               });
}

bool LoopbackLeaseWatch::still_silent(const Guid& observer, const Guid& observed,
                                      std::uint64_t generation) {
  const auto found = state_.topology.participants().find(observer);
  if (found == state_.topology.participants().end() || found->second->killed) return false;
  ParticipantCore& participant = *found->second;
  const auto view = participant.views.find(observed);
  if (view == participant.views.end() || view->second.generation != generation) return false;
  // Who is paused when the lease expires counts the silence anew when it resumes.
  if (participant.paused) view->second.heard = true;
  return !participant.paused;
}

void LoopbackLeaseWatch::expire_liveliness(const MatchId& id, std::uint64_t generation) {
  const auto found = state_.matches.find(id);
  if (found == state_.matches.end() || !found->second.reader_side || !found->second.alive) return;
  Match& match = found->second;
  if (!still_silent(match.reader->participant->guid, match.writer->participant->guid, generation)) {
    return;
  }
  match.alive = false;
  match.reader->queue.writer_not_alive(id.first);
  state_.callbacks.tell(match.reader, &ReaderListener::on_liveliness, id.first, false);
}

/// The observer drops all that it knows of the observed.
void LoopbackLeaseWatch::forget(ParticipantCore& observer, const Guid& observed) {
  View& view = observer.views[observed];
  if (!view.known) return;
  matching_.unmatch_all(observer, observed);
  view.known = false;
  tell_presence(observer, observed, false);
}

void LoopbackLeaseWatch::tell_presence(const ParticipantCore& observer, const Guid& observed,
                                       bool present) {
  if (!observer.options.on_participant) return;
  state_.callbacks.post(&observer, [tell = observer.options.on_participant, observed, present] {
    tell(observed, present);
  });
}

}  // namespace skein::dds::loopback
