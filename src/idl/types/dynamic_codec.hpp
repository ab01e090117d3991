#pragma once

#include <string>

#include "dynamic_type.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/detail/json.hpp"
#include "skein/guid.hpp"

/// CDR and JSON of types that are known by their description alone: the same bytes and the same
/// text as generated code has for them.
namespace skein::idl {

/// Writes what the JSON says. Throws InvalidArgument with the place in the JSON.
void encode_dynamic(CdrWriter& writer, const JsonReader& json, const DynamicType& type);

/// Throws MalformedSample for what is no such value.
void decode_dynamic(CdrReader& reader, JsonWriter& json, const DynamicType& type);

/// Reads a value and writes it again, as the message that it is written to requires: with other
/// alignment, in this side's version of a type that may grow. Throws MalformedSample for what is no
/// such value.
void copy_dynamic(CdrReader& reader, CdrWriter& writer, const DynamicType& type);

/// The JSON of a new value: what decode_dynamic() takes for members that the writer does not have.
std::string initial_json(const DynamicType& type);

/// Whether a topic of that type has an instance for each value of its key.
bool is_keyed(const DynamicType& type);
/// The key hash of a value.
Guid key_hash_of(const JsonReader& json, const DynamicType& type);

}  // namespace skein::idl
