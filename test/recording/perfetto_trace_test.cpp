#include "recording/viewers/perfetto_trace.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "recordings.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein;
using namespace skein::introspection;
using recording::PerfettoTrace;
using test::operator/;

namespace {

struct Shown {
  std::string process;
  std::string name;
  std::uint64_t begin;
  std::uint64_t end;
  std::size_t depth;  ///< So many slices lie around it.
  std::string flow;   ///< "from 7" or "to 7".
};

/// What a viewer shows. Fails where a slice ends that has not begun, or lies across another one.
std::vector<Shown> shown(const std::string& trace) {
  std::map<int, std::string> processes;  // by their numbers
  std::map<int, std::vector<Shown>> open;
  std::vector<Shown> slices;
  const auto parsed = nlohmann::json::parse(trace);
  for (const auto& event : parsed.at("traceEvents")) {
    if (event.at("ph") == "M") {
      if (event.at("name") == "process_name") processes[event["pid"]] = event["args"]["name"];
      continue;
    }
    const auto time = static_cast<std::uint64_t>(std::llround(event.at("ts").get<double>() * 1000));
    auto& stack = open[event.at("tid")];
    if (event.at("ph") == "B") {
      if (!stack.empty()) REQUIRE(stack.back().begin <= time);
      const std::string arrow = event.contains("flow_out") ? "from " : "to ";
      stack.push_back({processes.at(event.at("pid")), event.at("name"), time, 0, stack.size(),
                       event.contains("bind_id") ? arrow + event["bind_id"].dump() : ""});
    } else {
      REQUIRE_FALSE(stack.empty());
      stack.back().end = time;
      REQUIRE(stack.back().end >= stack.back().begin);
      slices.push_back(stack.back());
      stack.pop_back();
    }
  }
  for (const auto& [track, stack] : open) REQUIRE(stack.empty());
  return slices;
}

CallEvent event(std::uint64_t number, CallStep step, const std::string& entity,
                std::uint64_t time) {
  CallEvent event;
  event.client[0] = 7;
  event.number = number;
  event.step = step;
  event.entity = entity;
  event.service = "IPlanner";
  event.operation = "plan";
  event.time = time;
  return event;
}

Attempt attempt(const std::string& csp, std::int64_t began, std::int64_t took) {
  Attempt attempt;
  attempt.csp = csp;
  attempt.began = began;
  attempt.took = took;
  attempt.outcome = Outcome::Accepted;
  return attempt;
}

const Shown& named(const std::vector<Shown>& slices, const std::string& process,
                   const std::string& name) {
  const auto found = std::ranges::find_if(
      slices, [&](const Shown& slice) { return slice.process == process && slice.name == name; });
  REQUIRE(found != slices.end());
  return *found;
}

}  // namespace

TEST_CASE("a call is a slice at its caller and one at its provider, with an arrow between them") {
  PerfettoTrace trace;
  trace.add(event(1, CallStep::Sent, "uav/client", 1000));
  trace.add(event(1, CallStep::Received, "uav/navigator", 1100));
  trace.add(event(1, CallStep::Replied, "uav/navigator", 1800));
  trace.add(event(1, CallStep::Answered, "uav/client", 1900));
  const auto slices = shown(trace.finish());
  REQUIRE(slices.size() == 2);
  const Shown& caller = named(slices, "uav/client", "IPlanner.plan");
  const Shown& provider = named(slices, "uav/navigator", "IPlanner.plan");
  CHECK(caller.begin == 0);
  CHECK(caller.end == 900);
  CHECK(provider.begin == 100);
  CHECK(provider.end == 800);
  CHECK_THAT(caller.flow, Catch::StartsWith("from "));
  CHECK(provider.flow == "to " + caller.flow.substr(5));
}

TEST_CASE("calls at the same time lie on tracks of their own") {
  PerfettoTrace trace;
  for (std::uint64_t i = 1; i <= 5; ++i) trace.add(event(i, CallStep::Sent, "a", 100 * i));
  for (std::uint64_t i = 1; i <= 5; ++i)
    trace.add(event(i, CallStep::Answered, "a", 1000 + 50 * i));
  const auto slices = shown(trace.finish());
  CHECK(slices.size() == 5);
  for (const Shown& slice : slices) CHECK(slice.depth == 0);
}

TEST_CASE("a call that has no end lasts until the last event; one without beginning is not shown") {
  PerfettoTrace trace;
  trace.add(event(1, CallStep::Answered, "a", 50));
  trace.add(event(2, CallStep::Sent, "a", 100));
  trace.add(event(3, CallStep::Sent, "b", 900));
  const auto slices = shown(trace.finish());
  REQUIRE(slices.size() == 2);
  CHECK(named(slices, "a", "IPlanner.plan").end == 850);
}

TEST_CASE("a decision holds its attempts, those at the same time beside it") {
  Decision decision;
  decision.entity = "uav/navigator";
  decision.time = 1000;
  decision.took = 500;
  decision.service = "IPlanner";
  decision.attempts = {attempt("a_star", 10, 200), attempt("rrt", 100, 300),
                       attempt("dubins", 250, 900)};
  PerfettoTrace trace;
  trace.add(decision);
  const auto slices = shown(trace.finish());
  REQUIRE(slices.size() == 4);
  CHECK(named(slices, "uav/navigator", "decide IPlanner").end == 500);
  CHECK(named(slices, "uav/navigator", "a_star").depth == 1);
  CHECK(named(slices, "uav/navigator", "rrt").depth == 0);
  CHECK(named(slices, "uav/navigator", "dubins").depth == 1);
  CHECK(named(slices, "uav/navigator", "dubins").end == 500);
}

TEST_CASE("a trace is made of the topics of calls and decisions in a recording") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.mcap";
  {
    recording::Writer writer(path);
    const auto calls = writer.add_channel("skein/calls", 0);
    const auto decisions = writer.add_channel("skein/decisions", 0);
    const Bytes sent = idl::encode_message(CallEvents{{event(1, CallStep::Sent, "a", 100)}, 0});
    const Bytes decision = idl::encode_message(Decision{});
    writer.write({calls, 1, 1, 1, sent});
    writer.write({decisions, 1, 2, 2, decision});
    writer.write({calls, 2, 3, 3, test::bytes_of("no event")});
  }
  const auto done = export_to_perfetto(recording::Reader(path), folder / "a.json");
  CHECK(done.events == 1);
  CHECK(done.decisions == 1);
  CHECK(done.malformed == 1);
  CHECK(shown(test::content_of(folder / "a.json")).size() == 2);

  { const recording::Writer empty(folder / "b.mcap"); }
  CHECK_THROWS_WITH(export_to_perfetto(recording::Reader(folder / "b.mcap"), folder / "b"),
                    Catch::Contains("neither skein/calls nor skein/decisions"));
}
