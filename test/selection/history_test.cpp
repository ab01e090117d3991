#include "skein/detail/history.hpp"

#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "selection/service_history.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

const std::string kService = "crew/Worker";

/// Runs of requests of one size each, with numbers of their own.
class Past {
 public:
  void add(Duration took, double size = 1, bool accepted = true, std::optional<double> quality = {},
           const std::string& csp = "A") {
    add(csp, {sized(size), took, accepted, false, quality});
  }
  void add_late(Duration took, const std::string& csp = "A") {
    add(csp, {sized(1), took, false, true, {}});
  }
  /// As a Head does: with the prediction for this run.
  void add(const std::string& csp, History::Sample sample) {
    const auto predicted = history.predict(kService, {csp}, *sample.features).front();
    sample.request = history.begin(kService);
    history.add(kService, csp, sample, predicted ? &*predicted : nullptr);
  }
  std::optional<Prediction> find(const std::string& csp, double size) const {
    return history.predict(kService, {csp}, *sized(size)).front();
  }
  /// How many runs it still knows.
  std::size_t kept() const {
    const std::string text = history.to_json();
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find("\"took\"", at)) != std::string::npos; ++at) ++count;
    return count;
  }
  Prediction of(double size, const std::string& csp = "A") const { return find(csp, size).value(); }

  static std::shared_ptr<const Features> sized(double size) {
    return std::make_shared<const Features>(Features{{"size", size}});
  }

  History history;
};

std::string file_name() { return "history_test." + std::to_string(getpid()) + ".json"; }

struct File {
  std::string path = file_name();
  ~File() { std::remove(path.c_str()); }
};

}  // namespace

TEST_CASE("of a CSP that has never run nothing is predicted") {
  CHECK_FALSE(Past().find("A", 1).has_value());
}

TEST_CASE("once it has learned, what is predicted is what the CSP did on similar requests") {
  Past past;
  for (int i = 0; i < 30; ++i) {
    past.add(10ms, 100 + i, true, 0.9);
    past.add(70ms, 1000 + i, true, 0.5);
  }
  CHECK(past.of(110).quality.value() == Approx(0.7));
  past.history.learn();
  CHECK(past.of(110).median == 10ms);
  CHECK(past.of(110).quality.value() == Approx(0.9));
  CHECK(past.of(1005).median == 70ms);
  CHECK(past.of(1005).quality.value() == Approx(0.5));
}

TEST_CASE("features count by what they tell, whatever their scale") {
  Past past;
  for (int i = 0; i < 200; ++i) {
    const double noise = 1e6 * std::sin(i);
    const bool big = i % 2 == 0;
    past.add("A", {std::make_shared<const Features>(
                       Features{{"noise", noise}, {"size", big ? 0.002 : 0.001}}),
                   big ? 80ms : 5ms,
                   true,
                   false,
                   {}});
  }
  past.history.learn();
  for (const double noise : {-9e5, -1e5, 3e5, 8e5}) {
    CHECK(past.history.predict(kService, {"A"}, {{"noise", noise}, {"size", 0.002}})[0]->median ==
          80ms);
    CHECK(past.history.predict(kService, {"A"}, {{"noise", noise}, {"size", 0.001}})[0]->median ==
          5ms);
  }
}

TEST_CASE("a feature that is missing, unknown or no number does no harm") {
  Past past;
  for (int i = 0; i < 40; ++i) past.add(10ms, i);
  past.add("A",
           {std::make_shared<const Features>(Features{{"other", NAN}}), 10ms, true, false, {}});
  past.history.learn();
  CHECK(past.history.predict(kService, {"A"}, {})[0]->median == 10ms);
  CHECK(past.history.predict(kService, {"A"}, {{"size", NAN}, {"new", INFINITY}})[0]->median ==
        10ms);
}

TEST_CASE("CSPs and services have histories of their own") {
  Past past;
  past.add(10ms);
  past.history.add("other/Service", "A", {Past::sized(1), 90ms, true, false, {}});
  CHECK(past.of(1).median == 10ms);
  CHECK_FALSE(past.find("B", 1).has_value());
}

TEST_CASE("sixteen runs are predicted from, the latest of those that are equally similar") {
  Past past;
  for (int i = 0; i < 40; ++i) past.add(90ms + i % 3 * 1ms);
  for (const int i : {5, 12, 3, 16, 8, 1, 14, 10, 7, 2, 15, 9, 4, 11, 6, 13}) {
    past.history.add(kService, "A",
                     {Past::sized(1), i * 1ms, true, false, {}, past.history.begin(kService)});
  }
  CHECK(past.of(1).p95 == 16ms);
  CHECK(past.of(1).median == 8ms);
  CHECK(past.of(1).runs.size() == History::kNeighbours);
  past.history.learn();
  CHECK(past.of(1).p95 == 16ms);
}

TEST_CASE("runs on one request are known as such") {
  Past past;
  for (int i = 0; i < 5; ++i) {
    const std::uint64_t number = past.history.begin(kService);
    for (const std::string csp : {"A", "B"})
      past.history.add(kService, csp, {Past::sized(1), 1ms, true, false, {}, number});
  }
  past.history.learn();
  const auto both = past.history.predict(kService, {"A", "B"}, {{"size", 1}});
  REQUIRE(both[0]->runs.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) CHECK(both[0]->runs[i].request == both[1]->runs[i].request);
}

TEST_CASE("a CSP's runs where others had failed count as seldom as requests come to it") {
  Past past;
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t number = past.history.begin(kService);
    past.history.add(kService, "A", {Past::sized(1), 1ms, i % 10 > 0, false, {}, number, 0});
    if (i % 10 == 0)
      past.history.add(kService, "B", {Past::sized(1), 1ms, true, false, {}, number, 1});
  }
  CHECK(past.of(1, "A").runs.front().weight == Approx(1));
  CHECK(past.of(1, "B").runs.front().weight == Approx(0.1).margin(0.02));
}

TEST_CASE("a run that was given up counts with twice its time") {
  Past past;
  past.add_late(50ms);
  CHECK(past.of(1).p95 == 100ms);
}

TEST_CASE("a result that was rejected lowers the reliability and says nothing of the latency") {
  Past past;
  past.add(1ms, 1, false);
  CHECK(past.of(1).reliability == 0.5);
  CHECK_FALSE(past.of(1).p95.has_value());
  past.add(1ms, 1, true);
  CHECK(past.of(1).reliability == Approx(2.0 / 3));
}

TEST_CASE("once a CSP has become slower or faster, what is older is forgotten") {
  const auto [before, after] = GENERATE(std::pair<Duration, Duration>{10ms, 100ms},
                                        std::pair<Duration, Duration>{100ms, 10ms});
  Past past;
  const auto run = [&](Duration took, int i) { past.add(took * (1 + i * 37 % 100), i * 37 % 100); };
  for (int i = 0; i < 300; ++i) run(before, i);
  past.history.learn();
  for (int i = 0; i < 30; ++i) run(after, i);
  CHECK(past.kept() >= 30);
  CHECK(past.kept() < 60);
}

TEST_CASE("neither outliers nor heavy tails make anything forgotten") {
  Past past;
  for (int i = 0; i < 500; ++i)
    past.add(std::chrono::round<Duration>(3ms * std::pow((i * 37 % 100 + 1) / 101.0, -1 / 0.7)));
  CHECK(past.of(1).runs.size() == History::kNeighbours);
  CHECK(past.kept() == 500);
}

TEST_CASE("how long a CSP has not run is counted in requests to its service") {
  Past past;
  past.add(1ms);
  for (int i = 0; i < 7; ++i) past.history.begin(kService);
  past.history.note_exploration(kService);
  CHECK(past.of(1).idle == 7);
  CHECK(past.history.decisions(kService).made == 8);
  CHECK(past.history.decisions(kService).explored == 1);
}

TEST_CASE("a lesson is due once predictions were asked for and enough was added") {
  Past past;
  const auto run = [&] {
    past.history.add(kService, "A",
                     {Past::sized(1), 1ms, true, false, {}, past.history.begin(kService)});
  };
  for (int i = 0; i < 20; ++i) run();
  CHECK(past.history.next_lesson(kService) == nullptr);
  past.of(1);
  CHECK(past.history.next_lesson(kService) != nullptr);
}

TEST_CASE("what was added while a lesson was learned is not lost") {
  Past past;
  for (int i = 0; i < 30; ++i) past.add(10ms);
  const auto lesson = past.history.next_lesson(kService);
  REQUIRE(lesson != nullptr);
  for (int i = 0; i < 3; ++i) past.add(20ms);
  lesson->learn();
  past.history.take(*lesson);
  const auto runs = past.of(1).runs;
  CHECK(runs.size() == History::kNeighbours);
  CHECK(std::count_if(runs.begin(), runs.end(), [](const auto& run) { return run.took == 20ms; }) ==
        3);
}

TEST_CASE("a history that was saved is loaded the same, bit for bit") {
  Past past;
  for (int i = 0; i < 300; ++i) {
    past.add(Duration(1'000'003 * (i % 7)), 0.1 * i, i % 5 > 0, 1.0 / (i + 1), i % 3 ? "A" : "B");
    if (i % 11 == 0) past.history.note_exploration(kService);
  }
  const File file;
  past.history.save(file.path);
  History loaded = History::load(file.path);
  CHECK(loaded == past.history);
  CHECK(loaded.to_json() == past.history.to_json());
  loaded.learn();
  past.history.learn();
  const Features features{{"size", 12.3}};
  CHECK(loaded.predict(kService, {"A", "B"}, features) ==
        past.history.predict(kService, {"A", "B"}, features));
}

TEST_CASE("without a file the history is empty") {
  CHECK(History::load("no_such_history.json") == History());
}

TEST_CASE("a history that cannot be read is refused with file, place and remedy") {
  const File file;
  const auto write = [&](const std::string& text) { std::ofstream(file.path) << text; };
  write("{\"version\":2,\"csps\":[{\"service\":7");
  CHECK_THROWS_AS(History::load(file.path), InvalidArgument);
  CHECK_THROWS_WITH(History::load(file.path), Catch::Contains(file.path) &&
                                                  Catch::Contains("line 1") &&
                                                  Catch::Contains("remove it"));
  write(
      "{\"version\":2,\"csps\":[{\"service\":7,\"csp\":\"A\",\"changes\":{\"slower\":0,\"faster\":"
      "0,"
      "\"slower_since\":0,\"faster_since\":0},\"runs\":[]}],"
      "\"decisions\":[]}");
  CHECK_THROWS_WITH(History::load(file.path), Catch::Contains("$.csps[0].service"));
  write("{\"version\":1,\"csps\":[],\"decisions\":[]}");
  CHECK_THROWS_WITH(History::load(file.path), Catch::Contains("$.version is 1"));
  CHECK_THROWS_WITH(History::load("/dev/zero"), Catch::Contains("it is no regular file"));
  CHECK_THROWS_WITH(History().save("no_such_folder/history.json"),
                    Catch::Contains("no_such_folder"));
}
