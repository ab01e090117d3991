#include "recording/player.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <map>
#include <sstream>

#include "core/suggestion.hpp"
#include "dds/port.hpp"
#include "idl/dynamic_codec.hpp"
#include "idl/dynamic_support.hpp"
#include "recording/recorded_types.hpp"
#include "skein/detail/codec.hpp"
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
  if (!channel.metadata.contains("systems") || !channel.metadata.contains("type")) return false;
  const auto attachments = recording.attachments();
  return std::ranges::count(attachments, types_attachment(value_of(channel, "type"))) > 0;
}

/// Nothing where it says none, or no number.
std::optional<std::chrono::milliseconds> time_of(const Channel& channel, const std::string& name) {
  const std::string text = value_of(channel, name);
  std::int64_t milliseconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), milliseconds);
  if (error != std::errc() || end != text.data() + text.size() || milliseconds <= 0) return {};
  return std::chrono::milliseconds(milliseconds);
}

dds::Qos qos_of(const Channel& channel, const idl::DynamicType& type) {
  TopicQos qos;
  qos.deadline = time_of(channel, "deadline_ms");
  qos.liveliness_lease = time_of(channel, "lease_ms");
  qos.reliable = value_of(channel, "reliable") == "true";
  qos.transient_local = value_of(channel, "transient_local") == "true";
  qos.exclusive = value_of(channel, "exclusive") == "true";
  if (qos.transient_local) qos.history_depth = 1;
  if (is_xcdr2(type.representation)) qos.representation = dds::DataRepresentation::Xcdr2;
  qos.partitions = split(value_of(channel, "systems"));
  return qos;
}

types::TypeSystem types_of(const Reader& recording, const std::string& type) {
  const std::string told = recording.attachment(types_attachment(type)).data;
  return idl::decode_message<types::TypeSystem>(std::as_bytes(std::span(told)));
}

/// One topic as it is published again.
class Track {
 public:
  Track(Entity& entity, const Reader& recording, const Channel& channel)
      : types_(types_of(recording, value_of(channel, "type"))),
        support_(types_.type(value_of(channel, "type"))),
        keyed_(idl::is_keyed(support_.type)),
        writer_(entity.participant().create_writer(
            {channel.topic, std::string(support_.name), keyed_}, qos_of(channel, support_.type))) {}

  void publish(std::span<const std::byte> cdr) { writer_->write(cdr, key_of(cdr)); }
  void await_delivery(std::chrono::milliseconds patience) {
    writer_->wait_for_acknowledgments(patience);
  }

 private:
  Guid key_of(std::span<const std::byte> cdr) const {
    Guid key;
    if (!keyed_) return key;
    idl::DynamicValue value{&support_};
    support_.decode(&value, cdr, idl::kEncapsulation.size());
    idl::parse_json(value.json, [&](const idl::JsonReader& json) {
      key = idl::key_hash_of(json, support_.type);
    });
    return key;
  }

  const idl::DynamicTypes types_;
  const idl::DynamicSupport support_;
  const bool keyed_;
  std::unique_ptr<dds::Writer> writer_;
};

}  // namespace

struct Player::State {
  State(Entity& entity, const Reader& recording_, PlayerOptions options_)
      : recording(recording_), options(std::move(options_)) {
    check_names();
    for (const auto& [id, channel] : recording.channels()) {
      if (!is_wanted(channel)) continue;
      tracks.emplace(id, std::make_unique<Track>(entity, recording, channel));
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
  std::map<std::uint16_t, std::unique_ptr<Track>> tracks;
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
    track->second->publish(message->data);
    ++published;
  }
  const auto end = steady_clock::now() + kDeliveryPatience;
  for (const auto& [id, track] : state_->tracks) {
    const auto left = std::max<Duration>(end - steady_clock::now(), Duration::zero());
    track->await_delivery(std::chrono::ceil<std::chrono::milliseconds>(left));
  }
  return published;
}

}  // namespace skein::recording
