#pragma once

#include <iostream>
#include <optional>
#include <random>
#include <set>

#include "idl/types/dynamic_codec.hpp"
#include "idl/types/dynamic_support.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"

/// For describe_test.py: each type by its description alone, beside its generated code.

inline std::size_t failures = 0;
inline std::size_t compared = 0;

inline int report() {
  std::cout << compared << " values compared, " << failures << " differences\n";
  return failures == 0 && compared > 0 ? 0 : 1;
}

/// A message as one side reads it, and writes it again by its JSON.
struct Read {
  std::string json;
  std::size_t end = 0;
  std::string again;  ///< Empty where JSON cannot say it: half a surrogate pair, say.
  std::string key;

  bool operator==(const Read&) const = default;
};

inline skein::Bytes header_of(const skein::TypeSupport& support) {
  return skein::Bytes{std::span<const std::byte>(skein::encapsulation(support.representation))};
}

inline std::string written(const skein::TypeSupport& support, const void* value) {
  skein::Bytes message = header_of(support);
  support.encode(value, message);
  return {reinterpret_cast<const char*>(message.data()), message.size()};
}

/// What the type's own code makes of a message; nothing where that is no such value.
template <class T>
std::optional<Read> read_generated(const skein::TypeSupport& support, const skein::Bytes& message) {
  Read read;
  try {
    T value{};
    read.end = support.decode(&value, message, 4);
    read.json = support.to_json(&value);
  } catch (const skein::InvalidArgument&) {
    return std::nullopt;
  }
  try {
    T value{};
    support.from_json(&value, read.json);
    read.again = written(support, &value);
    if constexpr (requires { key_hash(value); }) read.key = key_hash(value).hex();
  } catch (const skein::InvalidArgument&) {
    read.again.clear();
  }
  return read;
}

inline std::optional<Read> read_dynamic(const skein::idl::DynamicSupport& support,
                                        const skein::Bytes& message) {
  Read read;
  skein::idl::DynamicValue value{&support};
  try {
    read.end = support.decode(&value, message, 4);
    read.json = value.json;
  } catch (const skein::InvalidArgument&) {
    return std::nullopt;
  }
  try {
    read.again = written(support, &value);
    if (skein::idl::is_keyed(support.type)) {
      skein::idl::parse_json(value.json, [&](const skein::idl::JsonReader& json) {
        read.key = skein::idl::key_hash_of(json, support.type).hex();
      });
    }
  } catch (const skein::InvalidArgument&) {
    read.again.clear();
  }
  return read;
}

/// Messages that are mostly values: the initial one, cut and with bytes changed, and random ones.
template <class T>
skein::Bytes message_for(const skein::TypeSupport& support, std::mt19937& random, int round) {
  skein::Bytes message = header_of(support);
  if (round % 2 == 0) {
    const T value{};
    try {
      support.encode(&value, message);
    } catch (const skein::InvalidArgument&) {  // an enumeration without a zero
    }
    for (int i = round / 4; i > 0 && message.size() > 4; --i) {
      message.data()[4 + random() % (message.size() - 4)] = static_cast<std::byte>(random() % 4);
    }
    return message;
  }
  std::vector<std::byte> bytes(random() % 200);
  for (auto& byte : bytes) byte = static_cast<std::byte>(random() % (random() % 4 == 0 ? 256 : 2));
  message.append(bytes);
  return message;
}

/// A new value's JSON is one that the type's own code takes, and gives again.
template <class T>
void check_initial(const skein::TypeSupport& support, const skein::idl::DynamicType& type) {
  ++compared;
  const std::string json = skein::idl::initial_json(type);
  std::string again;
  try {
    T value{};
    support.from_json(&value, json);
    again = support.to_json(&value);
  } catch (const skein::InvalidArgument& error) {
    again = error.what();
  }
  if (again == json) return;
  ++failures;
  std::cout << support.name << " begins with\n  " << json << "\n  " << again << "\n";
}

/// A value that is held as CDR is the same value, in this version of the type.
inline void check_copy(const skein::idl::DynamicType& type, const skein::Bytes& message,
                       const std::optional<Read>& expected) {
  const skein::idl::DynamicSupport support(type, skein::idl::DynamicForm::Cdr);
  skein::idl::DynamicValue value{&support};
  std::optional<Read> found;
  try {
    Read read;
    read.end = support.decode(&value, message, 4);
    read.json = skein::idl::json_of(value);
    read.again = expected ? expected->again : read.again;
    if (!read.again.empty()) read.again = written(support, &value);
    read.key = expected ? expected->key : read.key;
    found = read;
  } catch (const skein::InvalidArgument&) {
  }
  ++compared;
  if (expected == found || ++failures > 20) return;
  std::cout << support.name << " is copied as\n  "
            << (found ? found->json.substr(0, 2000) : "refused") << "\nnot as\n  "
            << (expected ? expected->json.substr(0, 2000) : "refused") << "\n";
}

template <class T>
void check_dynamic(const skein::idl::DynamicTypes& types) {
  const skein::TypeSupport& support = skein::idl::type_support<T>();
  if (support.description.declaration.empty() ||
      std::string_view(support.name) == "skein::ServiceReference")
    return;
  const skein::idl::DynamicSupport dynamic(types.type(std::string(support.name)));
  if (dynamic.representation != support.representation) {
    ++failures;
    std::cout << support.name << ": another representation\n";
  }
  check_initial<T>(support, dynamic.type);
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    const skein::Bytes message = message_for<T>(support, random, round);
    const auto expected = read_generated<T>(support, message);
    const auto found = read_dynamic(dynamic, message);
    check_copy(dynamic.type, message, expected);
    ++compared;
    if (expected == found) continue;
    if (++failures > 20) continue;
    std::cout << support.name << " differs in round " << round << "\n";
    for (const auto* read : {&expected, &found}) {
      std::cout << "  " << (*read ? (*read)->json.substr(0, 2000) : "refused") << "\n";
    }
  }
}
