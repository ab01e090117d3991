#include <thread>

#include "harbour.hpp"
#include "test/connector/pairing.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

/// A buoy whose code is C's.
struct CBuoy {
  static void on_call(void* user, const char* operation, const skein_value* arguments,
                      skein_reply reply) {
    auto& self = *static_cast<CBuoy*>(user);
    const std::string name = operation;
    self.told.note(name + text_of(*arguments), {});
    const CError error;
    if (name == "wind") {
      self.wind(text_of(*arguments), reply, error);
    } else if (name == "greet") {
      std::lock_guard lock(self.told.mutex);
      self.owed.push_back(reply);  // to be answered later
    } else if (name == "gusts") {
      for (int i = 0; i < 20; ++i) {
        const std::string gust =
            R"({"return_":{"force":)" + std::to_string(i) + R"(,"speed_m_s":0.5,"from":"Port"}})";
        if (!skein_reply_push(reply, skein_json(gust.c_str()), nullptr, error)) break;
      }
    } else if (name == "after") {
      skein_reply_free(reply, error);
    }
    self.told.note(error.text(), error);
  }

  void wind(const std::string& arguments, skein_reply reply, skein_error error) const {
    if (arguments.find("\"level\":0") != std::string::npos) {
      skein_reply_raise(reply, "harbour::Fog", skein_json(R"({"why":"low","sight_m":1.5})"), error);
    } else if (arguments.find("\"level\":1") != std::string::npos) {
      skein_reply_fail(reply, SKEIN_OVERLOADED, "too windy to measure", error);
    } else if (arguments.find("\"level\":2") != std::string::npos) {
      CHECK_FALSE(skein_reply_answer(reply, skein_json("{}"), error));  // and the reply goes on
      skein_reply_answer(
          reply, skein_json(R"({"return_":{"force":2,"speed_m_s":8,"from":"Port"},"stamp":5})"),
          {});
    }
  }

  skein_reply first_owed() {
    CHECK(eventually([&] {
      std::lock_guard lock(told.mutex);
      return !owed.empty();
    }));
    std::lock_guard lock(told.mutex);
    return owed.empty() ? skein_reply{} : owed.front();
  }

  Told told;
  std::vector<skein_reply> owed;
  const skein_service_callbacks callbacks{
      this, on_call, [](void* user) { ++static_cast<CBuoy*>(user)->told.closed; }};
};

/// What C knows of an interface: as the IDL compiler describes it.
skein_interface described(const CEntity& entity, const char* name = "harbour::IBuoy") {
  return entity.fetched(name);
}

struct CHarbour {
  std::unique_ptr<Entity> other = make_server("other");
  std::unique_ptr<Entity> caller = make_client("caller");
  CBuoy buoy;
  CEntity entity{"c", Pairing::get().server->name()};
  skein_provider provider{};
  CError error;

  CHarbour() {
    // The description comes from a provider in C++, which then goes.
    const Guid known = other->provide<harbour::IBuoy>(std::make_shared<Buoy>());
    const skein_interface interface = described(entity);
    other->withdraw(known);
    REQUIRE(
        skein_provider_new(entity.entity, interface, nullptr, &buoy.callbacks, &provider, error));
  }

  harbour::IBuoy::Proxy connect() { return caller->connect<harbour::IBuoy>({.name = "c"}); }
};

}  // namespace

TEST_CASE_METHOD(CHarbour, "C provides what C++ calls: results, exceptions, errors", "[wire]") {
  auto proxy = connect();
  std::int64_t stamp = 0;
  CHECK(proxy.wind(2, 3.5, stamp) == harbour::Wind{2, 8, harbour::Side::Port});
  CHECK(stamp == 5);
  CHECK(buoy.told.all().front() == R"(wind{"level":2,"at":3.5})");
  CHECK_THROWS_AS(proxy.wind(0, 3.5, stamp), harbour::Fog);
  CHECK_THROWS_AS(proxy.wind(1, 3.5, stamp), Overloaded);
  CHECK_THROWS_WITH(proxy.after(1), Catch::Contains("was not answered"));
  proxy.forget();
  CHECK(eventually([&] { return buoy.told.all().size() == 10; }));
}

TEST_CASE_METHOD(CHarbour, "C answers later, on another thread, and hears that nobody waits",
                 "[wire]") {
  auto proxy = connect();
  auto call = proxy.async_greet("you");
  const skein_reply reply = buoy.first_owed();
  std::int64_t left_ns = 0;
  CHECK(skein_reply_time_left(reply, &left_ns, error));
  CHECK(left_ns > 0);
  REQUIRE(skein_reply_answer(reply, skein_json(R"({"return_":"later"})"), error));
  CHECK(call.get() == "later");
  CHECK_FALSE(skein_reply_answer(reply, skein_json(R"({"return_":"again"})"), error));
  CHECK_THAT(error.text(), Catch::Contains("was freed, or has ended"));

  buoy.owed.clear();
  auto given_up = proxy.async_greet("nobody");
  const skein_reply owed = buoy.first_owed();
  Told told;
  const skein_cancel_callbacks callbacks{
      &told, [](void* user) { static_cast<Told*>(user)->note("cancelled", {}); }, Told::on_close};
  REQUIRE(skein_reply_on_cancel(owed, &callbacks, error));
  given_up.cancel();
  CHECK(eventually([&] { return told.all().size() == 1; }));
  bool cancelled = false;
  CHECK(skein_reply_cancelled(owed, &cancelled, error));
  CHECK(cancelled);
  CHECK(told.closed == 0);
  CHECK(skein_reply_free(owed, error));
  CHECK(eventually([&] { return told.closed == 1; }));
}

TEST_CASE_METHOD(CHarbour, "C streams, and the end of its callback is the stream's end", "[wire]") {
  auto proxy = connect();
  int count = 0;
  for (const harbour::Wind& wind : proxy.gusts(20)) CHECK(wind.force == count++);
  CHECK(count == 20);
  auto stream = proxy.gusts(20);
  CHECK(stream.next());
  stream.cancel();
  CHECK(eventually([&] { return buoy.told.last_kind() == SKEIN_CANCELLED; }));
}

TEST_CASE_METHOD(CHarbour, "what C provides is described to those that do not know it", "[wire]") {
  CEntity script("script", Pairing::get().client->name());
  const skein_interface fetched = script.fetched("c");
  skein_proxy proxy = script.connected(fetched);
  skein_result result{};
  REQUIRE(skein_proxy_call(proxy, "wind", skein_json(R"({"level":2,"at":1})"), 0, &result, error));
  CHECK_THAT(taken(result), Catch::Contains("\"stamp\":5"));
  skein_result first{};
  skein_result again{};
  skein_interface copy{};
  REQUIRE(skein_interface_describe(fetched, SKEIN_CDR, &first, error));
  skein_value description{};
  REQUIRE(skein_result_value(first, &description, error));
  REQUIRE(skein_interface_new(description.data, description.size, &copy, error));
  REQUIRE(skein_interface_describe(copy, SKEIN_CDR, &again, error));
  CHECK(taken(first) == taken(again));
}

TEST_CASE_METHOD(CHarbour, "a withdrawn service closes its callbacks once, and owes nothing") {
  auto proxy = connect();
  auto call = proxy.async_greet("you");
  const skein_reply reply = buoy.first_owed();
  CHECK(buoy.told.closed == 0);
  CHECK(skein_provider_free(provider, error));
  CHECK(buoy.told.closed == 1);
  CHECK_THROWS_AS(call.get(), Disconnected);
  CHECK(skein_reply_answer(reply, skein_json(R"({"return_":"too late"})"), error));
  CHECK_FALSE(skein_provider_free(provider, error));
  CHECK(skein_entity_free(entity.entity, error));
  CHECK(buoy.told.closed == 1);
}

TEST_CASE_METHOD(CHarbour, "the entity's end closes its services' callbacks") {
  CHECK(skein_entity_free(entity.entity, error));
  CHECK(buoy.told.closed == 1);
  CHECK(skein_provider_free(provider, error));
  CHECK(buoy.told.closed == 1);
}

TEST_CASE_METHOD(CHarbour,
                 "a drained entity serves what was sent, and refuses to be drained inside") {
  auto proxy = connect();
  auto call = proxy.async_greet("you");
  const skein_reply reply = buoy.first_owed();
  bool drained = false;
  bool done = false;
  std::thread draining(
      [&] { done = skein_entity_drain(entity.entity, 20 * SKEIN_SECOND, &drained, error); });
  CHECK(skein_reply_answer(reply, skein_json(R"({"return_":"still"})"), {}));
  CHECK(call.get() == "still");
  draining.join();
  CHECK(done);
  CHECK(drained);
}

TEST_CASE("C provides a CSP to its owner, in CDR") {
  const auto owner = make_server("owner");
  owner->provide<harbour::IReporter>(std::make_shared<Reporter>());
  CEntity entity{"c", Pairing::get().server->name()};
  const CError error;
  Told told;
  const skein_service_callbacks callbacks{
      &told,
      [](void* user, const char*, const skein_value* arguments, skein_reply reply) {
        auto in = value_of<harbour::IReporter_report_In>(text_of(*arguments));
        harbour::IReporter_report_Out out{in.earlier};
        out.return_.place = "from C";
        const Bytes made = idl::encode_message(out);
        const CError refused;
        skein_reply_answer(reply, cdr_of(made), refused);
        static_cast<Told*>(user)->note(refused.text(), refused);
      },
      Told::on_close};
  const skein_attribute quality{"quality", "0.5"};
  skein_service_options options{};
  options.csp = "Reporting";
  options.owner = "uav-1/owner";
  options.attributes = &quality;
  options.attributes_size = 1;
  options.encoding = SKEIN_CDR;
  skein_provider provider{};
  if (!skein_provider_new(entity.entity, entity.fetched("harbour::IReporter"), &options, &callbacks,
                          &provider, error)) {
    FAIL(error.text());
  }
  std::uint8_t identity[16] = {};
  CHECK(skein_provider_identity(provider, identity, error));
  const Task<harbour::IReporter, harbour::Report> task{
      {}, [](harbour::IReporter::Proxy& csp, Duration) {
        return csp.async_report({{{7, 1.25, harbour::Side::Port}}, "quay", {}});
      }};
  harbour::Report report;
  CHECK(eventually([&] {
    try {
      report = owner->head().perform(task);
      return report.place == "from C";  // and not from the owner's own service
    } catch (const NoCandidate&) {
      return false;
    }
  }));
  CHECK(report.winds.at(0).speed_m_s == 1.25);
  CHECK(skein_entity_free(entity.entity, {}));
  CHECK(told.all() == std::vector<std::string>{""});
  CHECK(told.closed == 1);
}
