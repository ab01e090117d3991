#include "recorded_states.hpp"

#include <algorithm>
#include <map>

#include "core/printable.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"

namespace skein::command::designer {
namespace {

/// So many states of a recording, evenly spread, are read to find all of its entities.
constexpr std::size_t kSampled = 30;

std::string json_in(const recording::Message& message) {
  return {reinterpret_cast<const char*>(message.data.data()), message.data.size()};
}

}  // namespace

RecordedStates::RecordedStates(const std::string& file) : reader_(file) {
  const auto has_states = [&](const auto& channel) { return channel.second.topic == kStates; };
  if (std::ranges::none_of(reader_.channels(), has_states)) {
    throw InvalidArgument("'" + printable(file) + "' has no topic " + kStates +
                          ", of what was to be seen: `skein record` writes it, unless told "
                          "--only-topics, if there is anybody on the domain");
  }
  auto messages = reader_.messages({{kStates}});
  while (const auto message = messages.next()) times_.push_back(message->log_time);
  if (times_.empty()) throw InvalidArgument("'" + printable(file) + "' has no state of a domain");
  std::string text;
  for (const std::uint64_t time : times_)
    text += (text.empty() ? "\"" : ",\"") + std::to_string(time) + "\"";
  times_text_ = std::make_shared<const std::string>("{\"times\":[" + text + "]}");
  place_all();
}

/// Places all entities of the recording, so that no box moves when the time changes.
void RecordedStates::place_all() {
  std::map<std::string, EntityState> entities;
  std::vector<Link> links;
  const std::size_t step = std::max<std::size_t>(times_.size() / kSampled, 1);
  for (std::size_t i = 0; i < times_.size(); i += step) {
    DomainState state = read(times_[i]);
    for (EntityState& entity : state.entities) {
      EntityState& known = entities[entity.name];
      if (known.services.size() <= entity.services.size()) known = std::move(entity);
    }
    for (Link& link : state.links) {
      const bool is_known = std::ranges::any_of(links, [&](const Link& each) {
        return each.source == link.source && each.target == link.target && each.name == link.name;
      });
      if (!is_known) links.push_back(std::move(link));
    }
  }
  std::vector<EntityState> all;
  for (auto& [name, entity] : entities) all.push_back(std::move(entity));
  layout_.arrange(all, links);
}

DomainState RecordedStates::read(std::uint64_t time) const {
  auto messages = reader_.messages({{kStates}, time, time});
  const auto message = messages.next();
  if (!message) throw InvalidArgument("this part of the recording is damaged");
  return idl::from_json<DomainState>(json_in(*message));
}

std::shared_ptr<const std::string> RecordedStates::at(std::uint64_t time) const {
  const auto after = std::ranges::upper_bound(times_, time);
  DomainState state = read(after == times_.begin() ? times_.front() : *std::prev(after));
  state.faults = false;
  {
    std::lock_guard lock(mutex_);
    layout_.arrange(state.entities, state.links);
  }
  return std::make_shared<const std::string>(idl::to_json(state));
}

}  // namespace skein::command::designer
