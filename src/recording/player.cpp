#include "recording/player.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <map>
#include <optional>
#include <sstream>

#include "core/log.hpp"
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
constexpr std::chrono::milliseconds kAcknowledgmentPeriod{100};

/// No replay waits longer for the next value: in so long a time somebody has set the clock of the
/// recorder (others' recordings have the wall clock's times), or nothing happened.
constexpr std::chrono::nanoseconds kLongestPause = std::chrono::hours(24);

/// When values are due, after the first one.
class Timetable {
 public:
  explicit Timetable(double rate) : rate_(rate) {}

  Duration due(std::uint64_t log_time) {
    const std::uint64_t pause = first_ ? 0 : log_time - last_;
    first_ = false;
    last_ = log_time;
    if (pause <= static_cast<std::uint64_t>(kLongestPause.count())) {
      recorded_ += pause;
    } else {
      const auto hours = pause / std::chrono::nanoseconds(std::chrono::hours(1)).count();
      log(LogLevel::Warning, "recording",
          "nothing was recorded for " + std::to_string(hours) +
              " h, or the recorder's clock was set by them; the replay leaves them out");
    }
    return std::chrono::duration_cast<Duration>(
        std::chrono::duration<double, std::nano>(static_cast<double>(recorded_) / rate_));
  }

 private:
  const double rate_;
  bool first_ = true;
  std::uint64_t last_ = 0;
  std::uint64_t recorded_ = 0;
};

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
  Timetable timetable(state_->options.rate);
  const auto begin = steady_clock::now();
  while (const auto message = messages.next()) {
    const auto track = state_->tracks.find(message->channel);
    if (track == state_->tracks.end()) continue;
    const auto left = begin + timetable.due(message->log_time) - steady_clock::now();
    if (pause(std::max<Duration>(left, Duration::zero()))) return published;
    track->second.publish_encoded(message->data);
    ++published;
  }
  const auto end = steady_clock::now() + kDeliveryPatience;
  for (auto& [id, track] : state_->tracks) {
    while (!track.wait_for_acknowledgments(kAcknowledgmentPeriod))
      if (pause(Duration::zero()) || steady_clock::now() >= end) return published;
  }
  return published;
}

}  // namespace skein::recording
