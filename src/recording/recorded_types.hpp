#pragma once

#include <map>
#include <mutex>
#include <set>
#include <string>

#include "recording/mcap/reader.hpp"
#include "recording/mcap/writer.hpp"
#include "skein/types.idl.hpp"

namespace skein::recording {

/// The name of the attachment with the types of a channel: a types::TypeSystem in CDR.
std::string types_attachment(const std::string& type);

/// Whether the recording holds it.
bool has_types(const Reader& recording, const std::string& type);
/// What it holds. Throws InvalidArgument if it is not there, or damaged.
types::TypeSystem types_of(const Reader& recording, const std::string& type);

/// The types of a recording: as schemas for viewers, as IDL for people, and as they were told for
/// replays. Thread-safe.
class RecordedTypes {
 public:
  explicit RecordedTypes(Writer& writer) : writer_(writer) {}

  /// A channel for values of a type. It has no schema where viewers have no such types.
  std::uint16_t add_channel(const std::string& topic, const std::string& type,
                            const types::TypeSystem& known,
                            std::map<std::string, std::string> metadata);

 private:
  std::uint16_t schema_of(const std::string& type, const types::TypeSystem& known);

  Writer& writer_;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas_;  // by name and text
  std::set<std::string> attached_;
};

}  // namespace skein::recording
