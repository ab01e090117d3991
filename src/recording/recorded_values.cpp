#include "recording/recorded_values.hpp"

#include <algorithm>
#include <map>

#include "core/suggestion.hpp"
#include "idl/types/dynamic_support.hpp"
#include "recording/recorded_types.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"

namespace skein::recording {
namespace {

std::string type_of(const Channel& channel) {
  const auto found = channel.metadata.find("type");
  return found == channel.metadata.end() ? "" : found->second;
}

/// The values of one channel.
struct Decoder {
  Decoder(const std::string& type, const types::TypeSystem& known)
      : types(known), support(types.type(type)) {}

  const std::string& json_of(std::span<const std::byte> cdr) {
    if (cdr.size() < idl::kEncapsulation.size()) throw InvalidArgument("it is too short");
    support.decode(&value, cdr, idl::kEncapsulation.size());
    return value.json;
  }

  idl::DynamicTypes types;
  idl::DynamicSupport support;
  idl::DynamicValue value{&support};
};

void demand(const Reader& recording, const std::vector<std::string>& topics,
            const std::vector<std::string>& readable) {
  if (readable.empty()) {
    throw InvalidArgument(
        "the recording does not hold the types of its values; only what `skein "
        "record` has written does");
  }
  for (const std::string& wanted : topics) {
    if (std::ranges::count(readable, wanted) > 0) continue;
    const bool there = std::ranges::any_of(
        recording.channels(), [&](const auto& each) { return each.second.topic == wanted; });
    throw InvalidArgument(there ? "the recording does not hold the type of '" + wanted + "'"
                                : "the recording has no topic '" + wanted + "'" +
                                      suggestion(wanted, readable));
  }
}

}  // namespace

std::string to_text(const UnreadValues& unread) {
  if (unread.count == 0) return {};
  return std::to_string(unread.count) + " values could not be read; the first is " + unread.first;
}

bool is_of_topic(const Channel& channel) { return channel.metadata.contains("systems"); }

UnreadValues for_each_value(const Reader& recording, const std::vector<std::string>& topics,
                            const std::function<bool(const RecordedValue&)>& visit) {
  std::vector<std::string> readable;
  std::map<std::uint16_t, Decoder> decoders;
  for (const auto& [id, channel] : recording.channels()) {
    if (!has_types(recording, type_of(channel))) continue;
    readable.push_back(channel.topic);
    if (topics.empty() || std::ranges::count(topics, channel.topic) > 0)
      decoders.try_emplace(id, type_of(channel), types_of(recording, type_of(channel)));
  }
  demand(recording, topics, readable);
  UnreadValues unread;
  Selection selection;
  selection.topics = topics;
  Messages messages = recording.messages(selection);
  while (const auto message = messages.next()) {
    const auto decoder = decoders.find(message->channel);
    if (decoder == decoders.end()) continue;
    const Channel& channel = recording.channels().at(message->channel);
    const std::string* json = nullptr;
    try {
      json = &decoder->second.json_of(message->data);
    } catch (const Error& error) {
      if (++unread.count == 1) unread.first = channel.topic + ": " + error.what();
      continue;
    }
    if (!visit({channel, message->log_time, *json})) break;
  }
  return unread;
}

}  // namespace skein::recording
