// A small mission, for tests of how missions are started: a desk that answers, one that fails its
// self-test, and those who ask.
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/head.hpp"
#include "skein/introspection.idl.hpp"
#include "test/tools/eventually.hpp"
#include "worker.idl.hpp"

namespace {

using namespace skein;
using namespace std::chrono_literals;

class Desk final : public crew::Desk {
 public:
  std::string ask(const std::string& text) override {
    while (text == "spin") spun_ = spun_ + 1;
    if (text == "die") std::abort();
    return "yes, " + text;
  }

 private:
  volatile unsigned spun_ = 0;
};

int ask(Entity& entity, const ParameterValues&) {
  auto desk = entity.connect<crew::Desk>();
  std::printf("the desk says: %s\n", desk.within(10s).ask("dear \x1b[31mclient").c_str());
  std::fflush(stdout);
  return 0;
}

/// Makes the desk spin, and asks it until it answers again.
int vex(Entity& entity, const ParameterValues&) {
  auto desk = entity.connect<crew::Desk>();
  const auto answers = [&](const std::string& text) {
    try {
      return desk.within(200ms).ask(text) == "yes, " + text;
    } catch (const Error&) {
      return false;
    }
  };
  if (!test::eventually([&] { return answers("once"); }) || answers("spin")) return 1;
  if (!test::eventually([&] { return answers("again"); }, 3 * test::kPatience)) return 2;
  std::puts("the desk answers again");
  std::fflush(stdout);
  return 0;
}

/// By which others know that the herald is at work.
constexpr char kHerald[] = "herald";

int call_out(Entity& entity, const ParameterValues&, const std::stop_token& told_to_end) {
  const auto sign = entity.publisher<introspection::Attempt>(kHerald);
  do {
    std::puts("hear, hear");
    std::fflush(stdout);
  } while (!await_end(entity, told_to_end, 20ms));
  std::puts("the herald goes home");
  std::fflush(stdout);
  return 0;
}

int call_thrice(Entity& entity, const ParameterValues&, const std::stop_token& told_to_end) {
  const auto herald = entity.subscription<introspection::Attempt>(kHerald);
  test::eventually([&] { return herald.publishers() > 0 || told_to_end.stop_requested(); });
  for (int i = 0; i < 3 && !await_end(entity, told_to_end, 1ms); ++i) std::puts("a word");
  std::fflush(stdout);
  return 3;
}

int ponder(Entity& entity, const ParameterValues& values, const std::stop_token& told_to_end) {
  const auto rate = values.live<int>("Rate", [](int wanted) {
    std::printf("ponders %d\n", wanted);
    std::fflush(stdout);
    std::promise<void>().get_future().wait();
  });
  while (!await_end(entity, told_to_end, 1s)) {
  }
  return 0;
}

using Made = std::function<int(const std::stop_token&)>;

int stumble(Entity&, const ParameterValues&) { throw std::runtime_error("the client stumbled"); }

/// What becomes of a component whose process was given `how` as its argument.
std::shared_ptr<Servant> make_badly(const std::string& how) {
  if (how == "nothing") return nullptr;
  if (how == "an int") throw 7;
  if (how == "a crash") std::abort();
  if (how == "never") {
    std::puts("is being made");
    std::fflush(stdout);
    std::promise<void>().get_future().wait();
  }
  throw std::runtime_error("no gauge at /dev/gauge");
}

}  // namespace

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_body<crew::Desk>("office", [](skein::Entity&, const skein::ParameterValues&) {
    return skein::ComponentRegistry::Body{
        std::make_shared<crew::Desk::Skeleton>(std::make_shared<Desk>())};
  });
  registry.add_mission("client", [arguments = registry.arguments()](
                                     skein::Entity& entity, const skein::ParameterValues& values) {
    for (const std::string& word : arguments) std::printf("argument: %s\n", word.c_str());
    return ask(entity, values);
  });
  registry.add_body<crew::Desk>("sick", [](skein::Entity&, const skein::ParameterValues&) {
    return skein::ComponentRegistry::Body{
        std::make_shared<crew::Desk::Skeleton>(std::make_shared<Desk>()), 1,
        [] { throw std::runtime_error("no compass"); }};
  });
  const auto arguments = registry.arguments();
  const std::string how = arguments.empty() ? "" : arguments.front();
  registry.add_body<crew::Desk>("bad", [how](skein::Entity&, const skein::ParameterValues&) {
    return skein::ComponentRegistry::Body{make_badly(how)};
  });
  registry.add_csp<crew::Desk>("bad_clerk",
                               [how](const skein::ParameterValues&) { return make_badly(how); });
  registry.add_activity(
      "thrower", [](skein::Entity&, const skein::ParameterValues&, const std::stop_token&) -> int {
        throw 7;
      });
  registry.add_activity("lost", [](skein::Entity&, const skein::ParameterValues&) -> Made {
    throw skein::InvalidArgument("there is no such way");
  });
  registry.add_activity("idle",
                        [](skein::Entity&, const skein::ParameterValues&) { return Made(); });
  registry.add_mission("vexer", vex);
  registry.add_mission("clumsy", stumble);
  registry.add_activity("herald", call_out);
  registry.add_activity("page", call_thrice);
  registry.add_activity("thinker", ponder);
}
