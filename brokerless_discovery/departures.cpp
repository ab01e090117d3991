#include "brokerless_discovery/departures.hpp"

#include <algorithm>
#include <cstdio>

#include "skein/discovery.idl.hpp"

namespace skein::brokerless_discovery {
namespace {

const char* departure_in_words(Departure how) {
  switch (how) {
    case Departure::Left:
      return "left";
    case Departure::Lost:
      return "was not heard of for its lease, and was given up";
    case Departure::Died:
      break;
  }
  return "died with its process";
}

}  // namespace

std::string in_words(const Absence& absence, Instant now) {
  char ago[32];
  std::snprintf(ago, sizeof ago, " %.1f s ago",
                std::chrono::duration<double>(now - absence.since).count());
  std::string text = "'" + absence.entity + "' " + departure_in_words(absence.how) + ago;
  if (absence.times > 1) text += " (" + std::to_string(absence.times) + " times by now)";
  return text + " and is not back";
}

Departures::Known& Departures::known(const ServiceDescription& description) {
  const auto found = std::ranges::find_if(known_, [&](const Known& known) {
    return known.absence.service == description.service &&
           known.absence.entity == description.entity;
  });
  if (found != known_.end()) return *found;
  if (known_.size() >= kMost) known_.pop_front();
  known_.push_back({{description.service, description.entity, Departure::Left, {}, 0}, true});
  return known_.back();
}

void Departures::note(const Table::Changes& changes, std::string_view owner, Instant now) {
  for (const Change& change : changes) {
    if (change.description->owner != owner) continue;
    Known& known = this->known(*change.description);
    if (change.kind == Change::Kind::Added) known.back = true;
    if (change.kind != Change::Kind::Removed) continue;
    known.back = false;
    known.absence.how = change.departure;
    known.absence.since = now;
    ++known.absence.times;
  }
}

std::vector<Absence> Departures::of(std::string_view service) const {
  std::vector<Absence> absent;
  for (const Known& known : known_) {
    if (!known.back && known.absence.service == service) absent.push_back(known.absence);
  }
  return absent;
}

}  // namespace skein::brokerless_discovery
