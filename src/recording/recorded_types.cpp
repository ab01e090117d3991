#include "recording/recorded_types.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "core/log.hpp"
#include "recording/viewers/recording_idl.hpp"
#include "skein/describe.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"

namespace skein::recording {

std::string types_attachment(const std::string& type) { return "types/" + type; }

bool has_types(const Reader& recording, const std::string& type) {
  return std::ranges::count(recording.attachments(), types_attachment(type)) > 0;
}

types::TypeSystem types_of(const Reader& recording, const std::string& type) {
  const std::string told = recording.attachment(types_attachment(type)).data;
  return idl::decode_message<types::TypeSystem>(std::as_bytes(std::span(told)));
}

std::uint16_t RecordedTypes::add_channel(const std::string& topic, const std::string& type,
                                         const types::TypeSystem& known,
                                         std::map<std::string, std::string> metadata) {
  std::lock_guard lock(mutex_);
  if (attached_.insert(type).second) {
    const Bytes told = idl::encode_message(known);
    writer_.attach({types_attachment(type), "application/x-cdr",
                    std::string(reinterpret_cast<const char*>(told.data()), told.size())});
    writer_.attach({"idl/" + type + ".idl", "text/plain", to_idl(known)});
  }
  return writer_.add_channel(topic, schema_of(type, known), std::move(metadata));
}

std::uint16_t RecordedTypes::schema_of(const std::string& type, const types::TypeSystem& known) {
  try {
    RecordingIdl idl = to_recording_idl(known, type);
    const auto [place, is_new] = schemas_.try_emplace({idl.type, idl.text});
    if (is_new) place->second = writer_.add_schema(idl.type, "omgidl", std::move(idl.text));
    return place->second;
  } catch (const InvalidArgument& error) {
    log(LogLevel::Warning, "recording",
        "values of " + type +
            " are recorded without a schema, and no viewer shows them: " + error.what());
    return 0;
  }
}

}  // namespace skein::recording
