#include "recording/player.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <map>
#include <sstream>

#include "core/suggestion.hpp"
#include "recording/recorded_types.hpp"
#include "recording/recorded_values.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/topic_qos.hpp"

namespace skein::recording {
namespace {

/// Of all topics together.
constexpr std::chrono::seconds kDeliveryPatience{5};

std::string value_of(const Channel& channel, const std::string& name) {
  const auto found = channel.metadata.find(name);
  return found == channel.metadata.end() ? "" : found->second;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

/// Whether it holds values of a topic that entities have, and whose types were told.
bool is_topic(const Reader& recording, const Channel& channel) {
  return is_of_topic(channel) && has_types(recording, value_of(channel, "type"));
}

/// Nothing if it says none, or no number.
std::optional<std::chrono::milliseconds> time_of(const Channel& channel, const std::string& name) {
  const std::string text = value_of(channel, name);
  std::int64_t milliseconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), milliseconds);
  if (error != std::errc() || end != text.data() + text.size() || milliseconds <= 0) return {};
  return std::chrono::milliseconds(milliseconds);
}

TopicQos qos_of(const Channel& channel) {
  TopicQos qos;
  qos.deadline = time_of(channel, "deadline_ms");
  qos.liveliness_lease = time_of(channel, "lease_ms");
  qos.reliable = value_of(channel, "reliable") == "true";
  qos.transient_local = value_of(channel, "transient_local") == "true";
  qos.exclusive = value_of(channel, "exclusive") == "true";
  if (qos.transient_local) qos.history_depth = 1;
  qos.systems = split(value_of(channel, "systems"));
  if (qos.systems.empty()) qos.systems = {""};
  return qos;
}

}  // namespace

struct Player::State {
  State(Entity& entity, const Reader& recording_, PlayerOptions options_)
      : recording(recording_), options(std::move(options_)) {
    check_names();
    for (const auto& [id, channel] : recording.channels()) {
      if (!is_wanted(channel)) continue;
      const std::string type = value_of(channel, "type");
      tracks.try_emplace(id, entity, channel.topic, type, types_of(recording, type),
                         qos_of(channel));
    }
    if (tracks.empty()) throw InvalidArgument("the recording has no topic that can be published");
  }

  bool is_wanted(const Channel& channel) const {
    return is_topic(recording, channel) &&
           (options.topics.empty() || std::ranges::count(options.topics, channel.topic) > 0);
  }

  void check_names() const {
    std::vector<std::string> known;
    for (const auto& [id, channel] : recording.channels()) {
      if (is_topic(recording, channel)) known.push_back(channel.topic);
    }
    for (const std::string& wanted : options.topics) {
      if (std::ranges::count(known, wanted) > 0) continue;
      throw InvalidArgument("the recording has no topic '" + wanted + "'" +
                            suggestion(wanted, known));
    }
  }

  const Reader& recording;
  const PlayerOptions options;
  std::map<std::uint16_t, DynamicPublisher> tracks;
};

Player::Player(Entity& entity, const Reader& recording, PlayerOptions options)
    : state_(std::make_unique<State>(entity, recording, std::move(options))) {}

Player::~Player() = default;

std::vector<std::string> Player::topics() const {
  std::vector<std::string> names;
  for (const auto& [id, track] : state_->tracks) {
    names.push_back(state_->recording.channels().at(id).topic);
  }
  return names;
}

std::size_t Player::subscribers() const {
  std::size_t count = 0;
  for (const auto& [id, track] : state_->tracks) count += track.subscribers();
  return count;
}

std::uint64_t Player::play(const std::function<bool(Duration)>& pause) {
  using std::chrono::steady_clock;
  Selection selection;
  selection.topics = topics();
  Messages messages = state_->recording.messages(selection);
  std::uint64_t published = 0;
  std::uint64_t first = 0;
  const auto begin = steady_clock::now();
  while (const auto message = messages.next()) {
    const auto track = state_->tracks.find(message->channel);
    if (track == state_->tracks.end()) continue;
    if (first == 0) first = message->log_time;
    const std::chrono::duration<double, std::nano> after(
        static_cast<double>(message->log_time - first) / state_->options.rate);
    const auto left = begin + std::chrono::duration_cast<Duration>(after) - steady_clock::now();
    if (pause(std::max<Duration>(left, Duration::zero()))) return published;
    track->second.publish_encoded(message->data);
    ++published;
  }
  const auto end = steady_clock::now() + kDeliveryPatience;
  for (auto& [id, track] : state_->tracks) {
    const auto left = std::max<Duration>(end - steady_clock::now(), Duration::zero());
    track.wait_for_acknowledgments(std::chrono::ceil<std::chrono::milliseconds>(left));
  }
  return published;
}

}  // namespace skein::recording
