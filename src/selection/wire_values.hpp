#pragma once

#include <optional>
#include <vector>

#include "skein/detail/history.hpp"
#include "skein/introspection.idl.hpp"

/// Between the Head's types and those that travel and are stored.
namespace skein::wire_values {

inline std::int64_t ns(Duration duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

inline Duration duration(std::int64_t ns) {
  return std::chrono::duration_cast<Duration>(std::chrono::nanoseconds(ns));
}

inline std::vector<std::int64_t> list(const std::optional<Duration>& value) {
  return value ? std::vector<std::int64_t>{ns(*value)} : std::vector<std::int64_t>{};
}

inline std::vector<double> list(const std::optional<double>& value) {
  return value ? std::vector<double>{*value} : std::vector<double>{};
}

inline std::optional<Duration> maybe(const std::vector<std::int64_t>& list) {
  return list.empty() ? std::nullopt : std::optional(duration(list.front()));
}

inline std::optional<double> maybe(const std::vector<double>& list) {
  return list.empty() ? std::nullopt : std::optional(list.front());
}

inline std::vector<introspection::NamedValue> list(const Features& features) {
  std::vector<introspection::NamedValue> list;
  for (const Feature& feature : features) list.push_back({feature.name, feature.value});
  return list;
}

inline Features features(const std::vector<introspection::NamedValue>& list) {
  Features features;
  for (const auto& value : list) features.push_back({value.name, value.value});
  return features;
}

}  // namespace skein::wire_values
