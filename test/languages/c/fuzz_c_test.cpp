#include <array>
#include <random>
#include <thread>

#include "buoy.idl.h"
#include "harbour.hpp"
#include "test/tools/invariant.hpp"

using namespace skein;
using namespace skein::test;

namespace {

constexpr int kThreads = 4;
constexpr int kSteps = 20'000;

/// The number that handles of a kind begin with.
template <class Handle>
constexpr std::size_t kKind = 0;
template <>
constexpr std::size_t kKind<skein_error> = 1;
template <>
constexpr std::size_t kKind<skein_result> = 2;
template <>
constexpr std::size_t kKind<skein_entity> = 3;
template <>
constexpr std::size_t kKind<skein_interface> = 4;
template <>
constexpr std::size_t kKind<skein_proxy> = 5;
template <>
constexpr std::size_t kKind<skein_call> = 6;
template <>
constexpr std::size_t kKind<skein_stream> = 7;
template <>
constexpr std::size_t kKind<skein_provider> = 8;
template <>
constexpr std::size_t kKind<skein_reply> = 9;
template <>
constexpr std::size_t kKind<skein_publisher> = 10;
template <>
constexpr std::size_t kKind<skein_subscription> = 11;
constexpr std::size_t kKinds = 12;

/// Handles that were given at any time, most of which were freed.
class Pool {
 public:
  void keep(std::uint64_t id) {
    std::lock_guard lock(mutex_);
    ids_[(id >> 56) % kKinds].push_back(id);
  }
  std::vector<std::uint64_t> all(std::size_t kind) {
    std::lock_guard lock(mutex_);
    return ids_[kind];
  }
  /// Mostly a recent one of the kind; else another one, or one that was never made.
  std::uint64_t any(std::size_t kind, std::mt19937& random) {
    const auto luck = random() % 20;
    if (luck == 0) return random() % 3 == 0 ? 0 : made_up(random);
    if (luck < 3) kind = random() % kKinds;
    std::lock_guard lock(mutex_);
    const auto& ids = ids_[kind];
    if (ids.empty()) return 0;
    const std::size_t last = std::min<std::size_t>(ids.size(), luck < 12 ? 4 : SIZE_MAX);
    return ids[ids.size() - 1 - random() % last];
  }

 private:
  static std::uint64_t made_up(std::mt19937& random) {
    const std::uint64_t kind = random() % 13;
    return kind << 56 | (random() % 2 == 0 ? random() % 4096 : std::uint64_t{random()} << 20);
  }

  std::mutex mutex_;
  std::array<std::vector<std::uint64_t>, kKinds> ids_;
};

/// Counts what was accepted and what was closed.
struct Closings {
  static void on_close(void* user) { ++static_cast<Closings*>(user)->closed; }
  std::atomic<int> accepted{0};
  std::atomic<int> closed{0};
  Pool pool;
};

class Fuzzer {
 public:
  Fuzzer(Closings& closings, unsigned seed) : closings_(closings), random_(seed) {}
  ~Fuzzer() { skein_error_free(error_); }

  void run() {
    for (int step = 0; step < kSteps; ++step) one();
  }

 private:
  template <class Handle>
  Handle any() {
    return {closings_.pool.any(kKind<Handle>, random_)};
  }
  template <class Handle>
  void keep(bool made, Handle handle) {
    if (made) closings_.pool.keep(handle.id);
  }
  void accepted(bool done) { closings_.accepted += done ? 1 : 0; }

  skein_value value() {
    static const std::vector<std::string> texts{
        "{}", "", "3", "\"x\"", R"({"level":1,"at":2})", R"({"count":3})", "{\"place\":", "[[[["};
    const std::string& text = texts[random_() % texts.size()];
    switch (random_() % 4) {
      case 0:
        return {text.data(), text.size(), static_cast<skein_encoding>(random_() % 5) - 1};
      case 1: {
        for (auto& byte : bytes_) byte = static_cast<unsigned char>(random_() % 9);
        bytes_[0] = 0;
        return skein_cdr(bytes_, random_() % sizeof bytes_);
      }
      case 2:
        return skein_struct(&in_, random_() % 3 == 0 ? 7 : sizeof in_);
      default:
        return skein_json(text.c_str());
    }
  }
  const char* operation() {
    static const char* const names[] = {"wind",  "greet",   "forget", "gusts",
                                        "after", "nothing", nullptr};
    return names[random_() % std::size(names)];
  }
  skein_error sink() { return random_() % 4 == 0 ? any<skein_error>() : error_; }

  void one() {
    switch (random_() % 24) {
      case 0:
        return make_proxy();
      case 1:
        return make_provider();
      case 2:
        return make_call();
      case 3:
        return make_stream();
      case 4:
        return make_topic();
      case 5:
        return answer();
      case 6:
        return void(skein_result_free(any<skein_result>(), sink()));
      case 7:
        return void(skein_proxy_free(any<skein_proxy>(), sink()));
      case 8:
        return void(skein_call_free(any<skein_call>(), sink()));
      case 9:
        return void(skein_stream_free(any<skein_stream>(), sink()));
      case 10:
        return void(skein_reply_free(any<skein_reply>(), sink()));
      case 11:
        return void(skein_publisher_free(any<skein_publisher>(), sink()));
      case 12:
        return void(skein_subscription_free(any<skein_subscription>(), sink()));
      case 13:
        return void(random_() % 8 == 0 && skein_provider_free(any<skein_provider>(), sink()));
      case 14:
        return void(random_() % 8 == 0 && skein_interface_free(any<skein_interface>(), sink()));
      case 15:
        return make_interface();
      case 16:
        return make_entity();
      case 17:
        return void(random_() % 200 == 0 && skein_entity_free(any<skein_entity>(), sink()));
      case 18:
        return next();
      case 19:
        return read();
      case 20:
        return void(skein_publisher_publish(any<skein_publisher>(), value(), sink()));
      case 21:
        return void(skein_call_cancel(any<skein_call>(), sink()));
      case 22:
        return convert();
      default:
        return call();
    }
  }

  void make_entity() {
    if (random_() % 40 != 0) return;
    skein_entity_options options{};
    const std::string name = "fuzz" + std::to_string(random_() % 1000);
    options.name = name.c_str();
    options.vendor = "loopback";
    options.system = "uav-1";
    options.domain = 17;
    skein_entity entity{};
    keep(skein_entity_new(&options, &entity, sink()), entity);
  }
  void make_interface() {
    skein_interface interface {};
    if (random_() % 3 == 0) return keep(buoy_types(&interface, sink()), interface);
    keep(harbour_IBuoy_interface(&interface, sink()), interface);
  }
  void make_proxy() {
    skein_connect_options options{};
    options.timeout_ns = 5 * SKEIN_MILLISECOND;
    skein_proxy proxy{};
    keep(skein_proxy_connect(any<skein_entity>(), any<skein_interface>(), &options, &proxy, sink()),
         proxy);
  }
  void make_provider() {
    if (random_() % 8 != 0) return;
    const skein_service_callbacks callbacks{
        &closings_,
        [](void* user, const char*, const skein_value*, skein_reply reply) {
          auto& closings = *static_cast<Closings*>(user);
          closings.pool.keep(reply.id);
          if (reply.id % 3 == 0) skein_reply_free(reply, {});
        },
        Closings::on_close};
    skein_service_options options{};
    options.encoding = static_cast<skein_encoding>(random_() % 4);
    skein_provider provider{};
    const bool done = skein_provider_new(any<skein_entity>(), any<skein_interface>(), &options,
                                         &callbacks, &provider, sink());
    accepted(done);
    keep(done, provider);
  }
  void make_call() {
    const skein_call_callbacks callbacks{&closings_, [](void*, const skein_value*, skein_error) {},
                                         Closings::on_close};
    skein_call call{};
    const bool told = random_() % 2 == 0;
    const bool done = skein_proxy_start(any<skein_proxy>(), operation(), value(), SKEIN_MILLISECOND,
                                        told ? &callbacks : nullptr, &call, sink());
    accepted(done && told);
    keep(done, call);
    if (done && random_() % 3 == 0) skein_call_wait(call, nullptr, sink());
  }
  void make_stream() {
    const skein_stream_callbacks callbacks{
        &closings_, [](void*, const skein_value*, skein_error) {}, Closings::on_close};
    skein_stream stream{};
    const bool told = random_() % 2 == 0;
    const bool done =
        skein_proxy_stream(any<skein_proxy>(), operation(), value(), SKEIN_MILLISECOND,
                           told ? &callbacks : nullptr, &stream, sink());
    accepted(done && told);
    keep(done, stream);
  }
  void make_topic() {
    skein_topic_options options{};
    options.profile = static_cast<skein_topic_profile>(random_() % 5);
    options.encoding = static_cast<skein_encoding>(random_() % 4);
    const char* const type = random_() % 3 == 0 ? nullptr : harbour_Depth_TYPE;
    if (random_() % 2 == 0) {
      skein_publisher publisher{};
      return keep(skein_publisher_new(any<skein_entity>(), any<skein_interface>(), type, "depth",
                                      &options, &publisher, sink()),
                  publisher);
    }
    const skein_subscription_callbacks callbacks{&closings_, [](void*, const skein_value*) {},
                                                 Closings::on_close};
    skein_subscription subscription{};
    const bool done = skein_subscription_new(any<skein_entity>(), any<skein_interface>(), type,
                                             "depth", &options, &callbacks, &subscription, sink());
    accepted(done);
    keep(done, subscription);
  }
  void answer() {
    const auto reply = any<skein_reply>();
    switch (random_() % 5) {
      case 0:
        return void(skein_reply_answer(reply, value(), sink()));
      case 1:
        return void(
            skein_reply_fail(reply, static_cast<skein_error_kind>(random_() % 12), "no", sink()));
      case 2:
        return void(skein_reply_raise(reply, harbour_Fog_TYPE, value(), sink()));
      case 3: {
        bool sent = false;
        return void(skein_reply_push(reply, value(), &sent, sink()));
      }
      default: {
        const skein_cancel_callbacks callbacks{&closings_, [](void*) {}, Closings::on_close};
        return accepted(skein_reply_on_cancel(reply, &callbacks, sink()));
      }
    }
  }
  void next() {
    skein_result result{};
    keep(skein_stream_next(any<skein_stream>(), &result, sink()), result);
  }
  void read() {
    skein_value read{};
    bool flag = false;
    std::int64_t left_ns = 0;
    skein_result_value(any<skein_result>(), &read, sink());
    skein_proxy_connected(any<skein_proxy>(), &flag, sink());
    skein_reply_cancelled(any<skein_reply>(), &flag, sink());
    skein_reply_time_left(any<skein_reply>(), &left_ns, sink());
    skein_error_clear(any<skein_error>());
  }
  void convert() {
    static const char* const types[] = {
        harbour_Cargo_TYPE, harbour_Depth_TYPE, "wind", "wind.out", ".out", ""};
    skein_result result{};
    keep(skein_interface_convert(any<skein_interface>(), types[random_() % std::size(types)],
                                 value(), static_cast<skein_encoding>(random_() % 4), &result,
                                 sink()),
         result);
  }
  void call() {
    skein_result result{};
    keep(skein_proxy_call(any<skein_proxy>(), operation(), value(), SKEIN_MILLISECOND, &result,
                          sink()),
         result);
  }

  Closings& closings_;
  std::mt19937 random_;
  const skein_error error_ = skein_error_new();
  unsigned char bytes_[64] = {};
  harbour_IBuoy_wind_in in_{};  // zeros, which are a value of any struct
};

}  // namespace

TEST_CASE("whatever handles and values come, from any thread: errors, and each close once") {
  skein_log_set_level(SKEIN_LOG_ERROR, {});  // of peers that do not match
  auto closings = std::make_unique<Closings>();
  {
    const CEntity entity("steady", "loopback");
    closings->pool.keep(entity.entity.id);
    std::vector<std::thread> threads;
    for (unsigned number = 0; number < kThreads; ++number) {
      threads.emplace_back([&closings, number] { Fuzzer(*closings, number + 1).run(); });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto id : closings->pool.all(kKind<skein_entity>)) skein_entity_free({id}, {});
    for (const auto id : closings->pool.all(kKind<skein_reply>)) skein_reply_free({id}, {});
  }
  CHECK(closings->accepted > 100);
  INVARIANT(eventually([&] { return closings->closed == closings->accepted; }));
  skein_log_set_level(SKEIN_LOG_INFO, {});
}
