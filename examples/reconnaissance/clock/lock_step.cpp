#include "lock_step.hpp"

#include <algorithm>

namespace reconnaissance {

void LockStep::hear(const Told& told) {
  if (told.leaves) {
    const auto found = participants_.find(told.participant);
    if (found != participants_.end() && found->second.life == told.life) participants_.erase(found);
    return;
  }
  auto [position, is_new] = participants_.try_emplace(told.participant);
  Participant& participant = position->second;
  if (is_new || participant.life != told.life)
    participant = {.life = told.life, .period = told.period, .joined = tick_};
  participant.done = std::max(participant.done, told.done);
  participant.looks = 0;
}

std::vector<std::string> LockStep::keep_connected(std::size_t connected, int patience) {
  std::vector<std::string> out;
  for (auto& [name, participant] : participants_) ++participant.looks;
  while (participants_.size() > connected) {
    const auto silent = std::ranges::max_element(
        participants_, {}, [](const auto& each) { return each.second.looks; });
    if (silent->second.looks < patience) break;
    out.push_back(silent->first);
    participants_.erase(silent);
  }
  return out;
}

bool LockStep::may_advance() const {
  if (tick_ < 0) return participants_.size() >= expected_;
  return std::none_of(participants_.begin(), participants_.end(),
                      [&](const auto& entry) { return owes(entry.second); });
}

std::vector<std::string> LockStep::awaited() const {
  std::vector<std::string> names;
  for (const auto& [name, participant] : participants_)
    if (owes(participant)) names.push_back(name);
  return names;
}

bool LockStep::owes(const Participant& participant) const {
  return tick_ > participant.joined && is_due(participant.period, tick_) &&
         participant.done < tick_;
}

}  // namespace reconnaissance
