#include <unistd.h>

#include <future>

#include "harbour.hpp"
#include "test/tools/threads.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

struct Harbour {
  std::shared_ptr<Buoy> buoy = std::make_shared<Buoy>();
  std::unique_ptr<Entity> provider = make_server("buoy");
  CEntity caller{"caller", Pairing::get().client->name()};
  CError error;

  Harbour() {
    provider->provide<harbour::IBuoy>(buoy, {.threads = 2});
    provider->provide<harbour::IReporter>(std::make_shared<Reporter>());
  }

  skein_interface interface = {};
  skein_proxy connect(const char* name = "harbour::IBuoy") {
    interface = caller.fetched(name);
    return caller.connected(interface);
  }
  skein_error_kind refused(skein_proxy proxy, const char* operation, const char* arguments) {
    skein_error_clear(error);
    CHECK_FALSE(skein_proxy_call(proxy, operation, skein_json(arguments), SKEIN_SECOND / 5, nullptr,
                                 error));
    return error.kind();
  }
};

}  // namespace

TEST_CASE_METHOD(Harbour, "C calls with JSON, without knowing the interface before", "[wire]") {
  const skein_proxy proxy = connect();
  const char* name = nullptr;
  REQUIRE(skein_interface_name(interface, &name, error));
  CHECK(std::string(name) == "harbour/IBuoy");

  skein_result result{};
  REQUIRE(skein_proxy_call(proxy, "greet", skein_json("\"you\""), 0, &result, error));
  CHECK(taken(result) == R"({"return_":"Ahoy, you"})");
  REQUIRE(
      skein_proxy_call(proxy, "wind", skein_json(R"({"level":3,"at":1.5})"), 0, &result, error));
  CHECK(taken(result) == R"({"return_":{"force":3,"speed_m_s":3,"from":"Starboard"},"stamp":77})");
  REQUIRE(skein_interface_example(interface, "wind", &result, error));
  CHECK(taken(result) == R"({"level":0,"at":0})");
  REQUIRE(skein_proxy_call(proxy, "forget", skein_json(nullptr), 0, &result, error));
  CHECK(taken(result) == "{}");
  CHECK(eventually([&] { return buoy->forgotten == 1; }));
}

TEST_CASE_METHOD(Harbour, "C calls with CDR, whatever alignment the message has", "[wire]") {
  const skein_proxy proxy = connect();
  skein_result result{};
  const Bytes in = idl::encode_message(harbour::IBuoy_wind_In{std::uint8_t{4}, 2.25});
  REQUIRE(skein_proxy_call(proxy, "wind", cdr_of(in), 0, &result, error));
  const auto out = value_of<harbour::IBuoy_wind_Out>(taken(result));
  CHECK(out.return_ == harbour::Wind{4, 4.5, harbour::Side::Starboard});
  CHECK(out.stamp == 77);
  REQUIRE(skein_proxy_call(proxy, "forget", skein_cdr(nullptr, 0), 0, nullptr, error));

  const skein_proxy reporter = connect("harbour::IReporter");
  const harbour::Report earlier{{{1, 2.5, harbour::Side::Port}}, "quay", 12.5};
  const Bytes report = idl::encode_message(harbour::IReporter_report_In{earlier});
  REQUIRE(skein_proxy_call(reporter, "report", cdr_of(report), 0, &result, error));
  const auto again = value_of<harbour::IReporter_report_Out>(taken(result)).return_;
  CHECK(again.place == "quay again");
  CHECK(again.winds.size() == 2);
  CHECK(again.depth_m == 12.5);
}

TEST_CASE_METHOD(Harbour, "bytes that are no CDR of the arguments are refused with the place") {
  const skein_proxy proxy = connect();
  Bytes in = idl::encode_message(harbour::IBuoy_wind_In{std::uint8_t{4}, 2.25});
  in.resize(in.size() - 1);
  CHECK_FALSE(skein_proxy_call(proxy, "wind", cdr_of(in), 0, nullptr, error));
  CHECK(error.kind() == SKEIN_INVALID_ARGUMENT);
  CHECK_THAT(error.text(), Catch::Contains("harbour::IBuoy::wind.at"));
  const Bytes longer = idl::encode_message(harbour::Depth{"a long name of a place", 2});
  CHECK_FALSE(skein_proxy_call(proxy, "wind", cdr_of(longer), 0, nullptr, error));
  CHECK_THAT(error.text(), Catch::Contains("ends at offset"));
  CHECK_FALSE(skein_proxy_call(proxy, "wind", skein_value{"", 0, 7}, 0, nullptr, error));
  CHECK_THAT(error.text(), Catch::Contains("7 is no encoding"));
}

TEST_CASE_METHOD(Harbour,
                 "C gets errors by class and text, declared exceptions by name and members") {
  const skein_proxy proxy = connect();
  CHECK(error.kind() == SKEIN_OK);
  CHECK(refused(proxy, "wnd", "{}") == SKEIN_INVALID_ARGUMENT);
  CHECK_THAT(error.text(), Catch::Contains("did you mean 'wind'"));
  CHECK(refused(proxy, "gusts", "3") == SKEIN_INVALID_ARGUMENT);
  CHECK_THAT(error.text(), Catch::Contains("skein_proxy_stream"));
  CHECK(refused(proxy, "wind", R"({"level":0,"at":2})") == SKEIN_DECLARED);
  const char* name = nullptr;
  skein_value members{};
  REQUIRE(skein_error_exception(error, &name, &members));
  CHECK(std::string(name) == "harbour::Fog");
  CHECK(text_of(members) == R"({"why":"it lies low","sight_m":2})");

  const Bytes in = idl::encode_message(harbour::IBuoy_wind_In{std::uint8_t{0}, 2.25});
  CHECK_FALSE(skein_proxy_call(proxy, "wind", cdr_of(in), 0, nullptr, error));
  REQUIRE(skein_error_exception(error, &name, &members));
  REQUIRE(members.encoding == SKEIN_CDR);
  CHECK(value_of<harbour::Fog>(text_of(members)).sight_m == 2.25);
  CHECK(skein_error_clear(error));
  CHECK(error.text().empty());
  CHECK_FALSE(skein_error_exception(error, &name, &members));
}

TEST_CASE_METHOD(Harbour, "a call ends at its deadline, and when it is cancelled", "[wire]") {
  const skein_proxy proxy = connect();
  CHECK_FALSE(skein_proxy_call(proxy, "after", skein_json("60000"), 20 * SKEIN_MILLISECOND, nullptr,
                               error));
  CHECK(error.kind() == SKEIN_TIMED_OUT);
  skein_call call{};
  REQUIRE(skein_proxy_start(proxy, "after", skein_json("60000"), 0, nullptr, &call, error));
  CHECK(skein_call_cancel(call, error));
  CHECK_FALSE(skein_call_wait(call, nullptr, error));
  CHECK(error.kind() == SKEIN_CANCELLED);
  CHECK(skein_call_free(call, error));
  CHECK_FALSE(skein_proxy_call(proxy, "after", skein_json("1"), -1, nullptr, error));
  CHECK_THAT(error.text(), Catch::Contains("timeout_ns is -1"));
}

TEST_CASE_METHOD(Harbour, "an asynchronous call tells its end once, then closes once", "[wire]") {
  const skein_proxy proxy = connect();
  Told told;
  const skein_call_callbacks callbacks{&told, Told::on_result, Told::on_close};
  REQUIRE(skein_proxy_start(proxy, "greet", skein_json("\"you\""), 0, &callbacks, nullptr, error));
  REQUIRE(eventually([&] { return told.closed == 1; }));
  CHECK(told.all() == std::vector<std::string>{R"({"return_":"Ahoy, you"})"});

  Told failed;
  const skein_call_callbacks failing{&failed, Told::on_result, Told::on_close};
  skein_call call{};
  REQUIRE(skein_proxy_start(proxy, "after", skein_json("60000"), 0, &failing, &call, error));
  CHECK_FALSE(skein_call_wait(call, nullptr, error));
  CHECK_THAT(error.text(), Catch::Contains("tells its result to a callback"));
  CHECK(skein_call_free(call, error));  // which cancels it
  REQUIRE(eventually([&] { return failed.closed == 1; }));
  CHECK(failed.last_kind() == SKEIN_CANCELLED);
  CHECK_FALSE(skein_proxy_start(proxy, "aftr", skein_json("1"), 0, &failing, nullptr, error));
  CHECK(failed.closed == 1);  // the function failed: nothing is told of it
}

TEST_CASE_METHOD(Harbour, "a stream is taken one result after the other, or told", "[wire]") {
  const skein_proxy proxy = connect();
  skein_stream stream{};
  REQUIRE(skein_proxy_stream(proxy, "gusts", skein_json("20"), 0, nullptr, &stream, error));
  int count = 0;
  skein_result item{};
  while (skein_stream_next(stream, &item, error) && item.id != 0) {
    CHECK_THAT(taken(item), Catch::Contains("\"force\":" + std::to_string(count++)));
  }
  CHECK(count == 20);
  CHECK(error.kind() == SKEIN_OK);
  CHECK(skein_stream_free(stream, error));

  Told told;
  const skein_stream_callbacks callbacks{&told, Told::on_result, Told::on_close};
  REQUIRE(skein_proxy_stream(proxy, "gusts", skein_json("20"), 0, &callbacks, nullptr, error));
  REQUIRE(eventually([&] { return told.closed == 1; }));
  CHECK(told.all().size() == 21);  // and the end
  CHECK(told.all().back().empty());
  CHECK(told.last_kind() == SKEIN_OK);
}

TEST_CASE_METHOD(Harbour, "the provider's end is a typed error") {
  const skein_proxy proxy = connect();
  Told told;
  const skein_call_callbacks callbacks{&told, Told::on_result, Told::on_close};
  REQUIRE(skein_proxy_start(proxy, "wind", skein_json(R"({"level":1,"at":1})"), 0, &callbacks,
                            nullptr, error));
  REQUIRE(eventually([&] { return told.closed == 1; }));
  provider.reset();
  CHECK(eventually([&] { return refused(proxy, "greet", "\"you\"") == SKEIN_UNAVAILABLE; }));
  bool connected = true;
  CHECK(skein_proxy_connected(proxy, &connected, error));
  CHECK_FALSE(connected);
}

TEST_CASE_METHOD(Harbour, "a call outlives its entity and its proxy, and ends as Disconnected") {
  const skein_proxy proxy = connect();
  skein_call call{};
  REQUIRE(skein_proxy_start(proxy, "after", skein_json("60000"), 0, nullptr, &call, error));
  REQUIRE(eventually([&] { return buoy->asked_to_wait == 1; }));
  CHECK(skein_entity_free(caller.entity, error));
  CHECK_FALSE(skein_call_wait(call, nullptr, error));
  CHECK(error.kind() == SKEIN_DISCONNECTED);
  CHECK(refused(proxy, "greet", "\"you\"") == SKEIN_UNAVAILABLE);
  CHECK(skein_proxy_free(proxy, error));
  CHECK(skein_call_free(call, error));
}

TEST_CASE_METHOD(Harbour,
                 "an entity is not freed in its own callback, which would wait for itself") {
  struct Freeing : Told {
    skein_entity entity{};
    std::atomic<bool> freed{true};
    std::string why;
  } freeing;
  freeing.entity = caller.entity;
  const skein_call_callbacks callbacks{static_cast<Told*>(&freeing),
                                       [](void* user, const skein_value*, skein_error) {
                                         auto& self =
                                             *static_cast<Freeing*>(static_cast<Told*>(user));
                                         const CError refusal;
                                         self.freed = skein_entity_free(self.entity, refusal);
                                         self.why = refusal.text();
                                       },
                                       Told::on_close};
  REQUIRE(
      skein_proxy_start(connect(), "greet", skein_json("\"a\""), 0, &callbacks, nullptr, error));
  REQUIRE(eventually([&] { return freeing.closed == 1; }));
  CHECK_FALSE(freeing.freed);
  CHECK_THAT(freeing.why, Catch::Contains("in a callback of this entity"));
}

TEST_CASE_METHOD(Harbour, "who waits for a provider is told when its entity ends") {
  const auto client = std::make_unique<CEntity>("waiting", Pairing::get().client->name());
  const skein_interface interface = client->fetched();
  std::atomic<pid_t> waiting = 0;
  auto waited = std::async(std::launch::async, [&] {
    const CError failure;
    skein_connect_options options{};
    options.name = "nobody";
    options.timeout_ns = 60 * SKEIN_SECOND;
    skein_proxy proxy{};
    waiting = ::gettid();
    const bool connected =
        skein_proxy_connect(client->entity, interface, &options, &proxy, failure);
    return connected ? SKEIN_OK : failure.kind();
  });
  REQUIRE(eventually([&] { return waiting != 0 && is_asleep(waiting); }));
  const auto freed = std::chrono::steady_clock::now();
  skein_entity_free(client->entity, client->error);
  CHECK(waited.get() == SKEIN_UNAVAILABLE);
  CHECK(std::chrono::steady_clock::now() - freed < 30s);
}

TEST_CASE("a handle that is 0, freed, of another kind, or invented is refused in words") {
  const CError error;
  skein_value value{};
  const auto why = [&](skein_result result) {
    CHECK_FALSE(skein_result_value(result, &value, error));
    CHECK(error.kind() == SKEIN_INVALID_ARGUMENT);
    return error.text();
  };
  CHECK_THAT(why({}), Catch::Contains("the skein_result is 0"));
  CHECK_THAT(why({error.sink.id}),
             Catch::Contains("a skein_error was given in place of a skein_result"));
  CHECK_THAT(why({0xFFFFFFFFFFFFFFFFU}), Catch::Contains("is no handle that Skein has made"));
  const skein_error other = skein_error_new();
  CHECK(skein_error_free(other));
  CHECK_FALSE(skein_error_free(other));
  CHECK(skein_result_free({}, error));  // as free(NULL)
  CHECK(skein_error_class(other) == SKEIN_OK);
  CHECK(std::string(skein_error_text(other)).empty());
}

TEST_CASE("options of a later version, and what lacks its name, are refused") {
  const CError error;
  skein_entity entity{};
  skein_entity_options options{};
  CHECK_FALSE(skein_entity_new(&options, &entity, error));
  CHECK_THAT(error.text(), Catch::Contains("the entity's name is NULL"));
  options.reserved[3] = 1;
  CHECK_FALSE(skein_entity_new(&options, &entity, error));
  CHECK_THAT(error.text(), Catch::Contains("`reserved`"));
  skein_interface interface {};
  CHECK_FALSE(skein_interface_new("nonsense", 8, &interface, error));
  CHECK_THAT(error.text(), Catch::Contains("no description that the IDL compiler has written"));
}
