#pragma once

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "buoy.idl.hpp"
#include "skein/c/skein.h"
#include "skein/detail/codec.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/eventually.hpp"

namespace skein::test {

class Buoy : public harbour::IBuoy {
 public:
  harbour::Wind wind(std::uint8_t level, double at, std::int64_t& stamp) override {
    if (level == 0) throw harbour::Fog("it lies low", at);
    stamp = 77;
    return {level, at * 2, harbour::Side::Starboard};
  }
  std::string greet(const std::string& name) override { return "Ahoy, " + name; }
  void forget() override { ++forgotten; }
  void gusts(std::int32_t count, StreamSink<harbour::Wind>& out) override {
    for (std::int32_t i = 0; i < count; ++i) {
      out.push({static_cast<std::uint8_t>(i), i + 0.5, harbour::Side::Port});
    }
  }
  std::int32_t after(std::int32_t ms) override {
    ++asked_to_wait;
    const auto& call = *CallContext::current();
    eventually([&] { return call.cancelled(); }, std::chrono::milliseconds(ms));  // it is slow
    return ms;
  }

  std::atomic<int> forgotten{0};
  std::atomic<int> asked_to_wait{0};
};

class Reporter : public harbour::IReporter {
 public:
  harbour::Report report(const harbour::Report& earlier) override {
    harbour::Report report = earlier;
    report.place += " again";
    report.winds.push_back({9, 30.25, harbour::Side::Port});
    return report;
  }
};

/// Where C puts its errors.
struct CError {
  CError() = default;
  ~CError() { skein_error_free(sink); }
  CError(const CError&) = delete;
  CError& operator=(const CError&) = delete;
  operator skein_error() const noexcept { return sink; }
  skein_error_kind kind() const { return skein_error_class(sink); }
  std::string text() const { return skein_error_text(sink); }

  const skein_error sink = skein_error_new();
};

inline std::string text_of(const skein_value& value) {
  return {static_cast<const char*>(value.data), value.size};
}

/// What a result says, which is freed.
inline std::string taken(skein_result result) {
  skein_value value{};
  REQUIRE(skein_result_value(result, &value, {}));
  std::string text = text_of(value);
  CHECK(skein_result_free(result, {}));
  return text;
}

template <class T>
T value_of(const std::string& cdr) {
  return idl::decode_message<T>(std::as_bytes(std::span(cdr)));
}

inline skein_value cdr_of(const Bytes& message) {
  return skein_cdr(message.data(), message.size());
}

/// An entity of the C interface.
struct CEntity {
  explicit CEntity(const char* name, const std::string& vendor, std::int64_t lease_ns = 0) {
    skein_entity_options options{};
    options.name = name;
    options.system = "uav-1";
    options.vendor = vendor.c_str();
    options.domain = 17;
    options.lease_ns = lease_ns;
    if (!skein_entity_new(&options, &entity, error)) FAIL(error.text());
  }
  ~CEntity() { skein_entity_free(entity, {}); }
  CEntity(const CEntity&) = delete;
  CEntity& operator=(const CEntity&) = delete;

  skein_interface fetched(const char* name = "harbour::IBuoy") const {
    skein_interface interface {};
    if (!skein_interface_fetch(entity, name, 0, &interface, error)) FAIL(error.text());
    return interface;
  }
  skein_proxy connected(skein_interface interface) const {
    skein_proxy proxy{};
    if (!skein_proxy_connect(entity, interface, nullptr, &proxy, error)) FAIL(error.text());
    return proxy;
  }

  CError error;
  skein_entity entity{};
};

/// What callbacks were told.
struct Told {
  static void on_result(void* user, const skein_value* result, skein_error error) {
    static_cast<Told*>(user)->note(result ? text_of(*result) : "", error);
  }
  static void on_close(void* user) { ++static_cast<Told*>(user)->closed; }

  void note(std::string text, skein_error error) {
    std::lock_guard lock(mutex);
    texts.push_back(std::move(text));
    kinds.push_back(skein_error_class(error));
  }
  std::vector<std::string> all() {
    std::lock_guard lock(mutex);
    return texts;
  }
  skein_error_kind last_kind() {
    std::lock_guard lock(mutex);
    return kinds.empty() ? SKEIN_OK : kinds.back();
  }

  std::mutex mutex;
  std::vector<std::string> texts;
  std::vector<skein_error_kind> kinds;
  std::atomic<int> closed{0};
};

}  // namespace skein::test
