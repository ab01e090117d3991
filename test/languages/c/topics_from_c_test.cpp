#include "buoy.idl.h"
#include "harbour.hpp"
#include "skein/log.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

struct Values {
  CEntity sender{"sender", Pairing::get().server->name()};
  CEntity receiver{"receiver", Pairing::get().client->name()};
  CError error;
  Told told;
  skein_interface types{};
  skein_topic_options options{};
  skein_publisher publisher{};
  skein_subscription subscription{};
  skein_subscription_callbacks callbacks{&told,
                                         [](void* user, const skein_value* value) {
                                           static_cast<Told*>(user)->note(text_of(*value), {});
                                         },
                                         Told::on_close};

  Values() {
    REQUIRE(buoy_types(&types, error));
    options.profile = SKEIN_TOPIC_STATE;
    if (!skein_publisher_new(sender.entity, types, harbour_Depth_TYPE, "depth", &options,
                             &publisher, error)) {
      FAIL(error.text());
    }
  }

  void subscribe() {
    if (!skein_subscription_new(receiver.entity, types, harbour_Depth_TYPE, "depth", &options,
                                &callbacks, &subscription, error)) {
      FAIL(error.text());
    }
  }
  void publish(double depth_m) {
    const harbour_Depth depth{"quay", depth_m};
    if (!skein_publisher_publish(publisher, skein_struct(&depth, sizeof depth), error)) {
      FAIL(error.text());
    }
  }
};

}  // namespace

TEST_CASE_METHOD(Values, "C publishes and subscribes: structs, JSON, CDR", "[wire]") {
  subscribe();
  publish(2.5);
  REQUIRE(eventually([&] { return told.all().size() == 1; }));
  CHECK(told.all()[0] == R"({"place":"quay","depth_m":2.5})");
  std::size_t count = 0;
  CHECK(skein_publisher_subscribers(publisher, &count, error));
  CHECK(count == 1);
  CHECK(skein_subscription_publishers(subscription, &count, error));
  CHECK(count == 1);
  bool acknowledged = false;
  CHECK(skein_publisher_wait(publisher, 0, &acknowledged, error));
  CHECK(acknowledged);
  CHECK_FALSE(skein_publisher_publish(publisher, skein_json(R"({"plac":"x"})"), error));
  CHECK_THAT(error.text(), Catch::Contains("plac"));
  CHECK(skein_subscription_free(subscription, error));
  CHECK(told.closed == 1);

  options.encoding = SKEIN_CDR;
  subscribe();  // and gets the state
  REQUIRE(eventually([&] { return told.all().size() == 2; }));
  CHECK(value_of<harbour::Depth>(told.all()[1]).depth_m == 2.5);
  skein_entity_free(receiver.entity, error);
  CHECK(told.closed == 2);
}

TEST_CASE_METHOD(Values, "C++ and C share a topic, whose types C may ask for", "[wire]") {
  const auto listener = make_client("listener");
  std::atomic<double> heard{0};
  const auto subscription = listener->subscription<harbour::Depth>(
      "depth", TopicQos::state(), [&](const harbour::Depth& depth) { heard = depth.depth_m; });
  skein_interface fetched{};
  if (!skein_interface_fetch_topic(receiver.entity, "depth", 0, &fetched, error)) {
    FAIL(error.text());
  }
  skein_publisher again{};
  REQUIRE(skein_publisher_new(receiver.entity, fetched, nullptr, "depth", &options, &again, error));
  REQUIRE(skein_publisher_publish(again, skein_json(R"({"place":"mole","depth_m":4})"), error));
  CHECK(eventually([&] { return heard == 4; }));
  CHECK_FALSE(skein_interface_fetch_topic(receiver.entity, "nothing", 0, &fetched, error));
  CHECK(error.kind() == SKEIN_UNAVAILABLE);
}

TEST_CASE_METHOD(Values, "a subscription is not freed in its own callback") {
  struct Freeing : Told {
    skein_subscription subscription{};
    std::atomic<int> refused{0};
  } freeing;
  callbacks = {static_cast<Told*>(&freeing),
               [](void* user, const skein_value*) {
                 auto& self = *static_cast<Freeing*>(static_cast<Told*>(user));
                 if (!skein_subscription_free(self.subscription, {})) ++self.refused;
               },
               Told::on_close};
  subscribe();
  freeing.subscription = subscription;
  publish(1);
  CHECK(eventually([&] { return freeing.refused == 1; }));
  CHECK(skein_subscription_free(subscription, error));
  CHECK(freeing.closed == 1);
}

TEST_CASE("C gets the log's lines on a thread where it may call Skein") {
  const CError error;
  Told told;
  const skein_log_callbacks callbacks{
      &told,
      [](void* user, skein_log_level level, const char* place, const char* text, std::int64_t) {
        skein_error_free(skein_error_new());
        static_cast<Told*>(user)->note(std::to_string(level) + place + text, {});
      },
      Told::on_close};
  REQUIRE(skein_log_set_sink(&callbacks, error));
  REQUIRE(skein_log_write(SKEIN_LOG_WARNING, "quay", "fog", error));
  CHECK(eventually([&] { return !told.all().empty() && told.all().back() == "2quayfog"; }));
  CHECK(skein_log_set_sink(nullptr, error));
  CHECK(told.closed == 1);
  CHECK_FALSE(skein_log_write(9, "quay", "fog", error));
  CHECK_THAT(error.text(), Catch::Contains("9 is no level"));
}

TEST_CASE("C has its Head choose, check and compare what CSPs answer") {
  CEntity head{"head", Pairing::get().server->name()};
  const CError error;
  skein_interface interface {};
  REQUIRE(harbour_IBuoy_interface(&interface, error));
  const char* owner = nullptr;
  REQUIRE(skein_entity_id(head.entity, &owner, error));
  struct Csp {
    double speed;
    Told told;
  } slow{2, {}}, fast{9, {}};
  for (Csp* csp : {&slow, &fast}) {
    skein_service_options options{};
    options.csp = csp == &slow ? "Slow" : "Fast";
    options.owner = owner;
    harbour_IBuoy_functions functions{};
    functions.wind = [](void* user, const harbour_IBuoy_wind_in* in, skein_reply reply) {
      const harbour_Wind wind{in->level, static_cast<Csp*>(user)->speed, harbour_Side_Port};
      harbour_IBuoy_wind_answer(reply, &wind, 1, {});
    };
    functions.on_close = [](void* user) { ++static_cast<Csp*>(user)->told.closed; };
    skein_provider provider{};
    if (!harbour_IBuoy_provide(head.entity, &options, &functions, csp, &provider, error)) {
      FAIL(error.text());
    }
  }
  const harbour_IBuoy_wind_in in{3, 1.5};
  skein_task task{};
  task.operation = "wind";
  task.arguments = skein_struct(&in, sizeof in);
  task.execution = SKEIN_EXECUTE_ALL;
  task.enough = SIZE_MAX;
  task.request = "by cost";
  skein_task_callbacks callbacks{};
  callbacks.cost = [](void*, const skein_value* result) {
    return -static_cast<const harbour_IBuoy_wind_out*>(result->data)->return_.speed_m_s;
  };
  skein_result result{};
  skein_result decision{};
  if (!skein_entity_perform(head.entity, interface, &task, &callbacks, &result, &decision, error)) {
    FAIL(error.text());
  }
  skein_value value{};
  REQUIRE(skein_result_value(result, &value, error));
  CHECK(static_cast<const harbour_IBuoy_wind_out*>(value.data)->return_.speed_m_s == 9);
  CHECK_THAT(taken(decision), Catch::Contains("by cost") && Catch::Contains("Fast costs least"));

  callbacks.user = &head;
  callbacks.evaluate = [](void* user, const skein_value*, skein_error reason) {
    CHECK_FALSE(skein_entity_free(static_cast<CEntity*>(user)->entity, {}));  // it is in use
    skein_error_set(reason, SKEIN_INTERNAL, "it smells of fog");
    return false;
  };
  CHECK_FALSE(
      skein_entity_perform(head.entity, interface, &task, &callbacks, nullptr, &decision, error));
  CHECK(error.kind() == SKEIN_INTERNAL);
  CHECK_THAT(taken(decision), Catch::Contains("it smells of fog"));
  CHECK(skein_entity_free(head.entity, error));
  CHECK(slow.told.closed + fast.told.closed == 2);
}
