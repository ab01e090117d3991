#include "skein/detail/history.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>

#include "skein/error.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

const std::string kService = "crew/Worker";

History::Sample ran(Duration took, double size = 1, bool accepted = true,
                    std::optional<double> quality = {}) {
  return {{{"size", size}}, took, accepted, false, quality, 0};
}

Prediction of(const History& history, double size, const std::string& csp = "A") {
  return history.predict(kService, csp, {{"size", size}}).value();
}

std::string file_name() { return "history_test." + std::to_string(getpid()) + ".json"; }

struct File {
  std::string path = file_name();
  ~File() { std::remove(path.c_str()); }
};

}  // namespace

TEST_CASE("of a CSP that has never run nothing is predicted") {
  CHECK_FALSE(History().predict(kService, "A", {}).has_value());
}

TEST_CASE("what is predicted is what the CSP did on the most similar requests") {
  History history;
  for (int i = 0; i < 30; ++i) {
    history.add(kService, "A", ran(10ms, 100, true, 0.9));
    history.add(kService, "A", ran(70ms, 1000, true, 0.5));
  }
  CHECK(of(history, 110).median == 10ms);
  CHECK(of(history, 110).quality.value() == Approx(0.9));
  CHECK(of(history, 900).median == 70ms);
  CHECK(of(history, 900).quality.value() == Approx(0.5));
}

TEST_CASE("CSPs and services have histories of their own") {
  History history;
  history.add(kService, "A", ran(10ms));
  history.add("other/Service", "A", ran(90ms));
  CHECK(of(history, 1).median == 10ms);
  CHECK_FALSE(history.predict(kService, "B", {}).has_value());
}

TEST_CASE(
    "the p95 latency is that of the slowest of twelve similar requests, the median that of the "
    "sixth") {
  History history;
  for (int i = 12; i > 0; --i) history.add(kService, "A", ran(i * 1ms));
  CHECK(of(history, 1).p95 == 12ms);
  CHECK(of(history, 1).median == 6ms);
  CHECK(of(history, 1).samples == 12);
}

TEST_CASE("a run that was given up counts with twice its time") {
  History history;
  auto late = ran(50ms, 1, false);
  late.late = true;
  history.add(kService, "A", late);
  CHECK(of(history, 1).p95 == 100ms);
}

TEST_CASE("a result that was rejected lowers the reliability and says nothing of the latency") {
  History history;
  history.add(kService, "A", ran(1ms, 1, false));
  CHECK(of(history, 1).reliability == 0.5);
  CHECK_FALSE(of(history, 1).p95.has_value());
  history.add(kService, "A", ran(1ms, 1, true));
  CHECK(of(history, 1).reliability == Approx(2.0 / 3));
}

TEST_CASE("five runs in a row of half or twice the time make what is older forgotten") {
  History history;
  const auto [before, after] = GENERATE(std::pair<Duration, Duration>{10ms, 100ms},
                                        std::pair<Duration, Duration>{100ms, 10ms});
  for (int i = 0; i < 50; ++i) history.add(kService, "A", ran(before));
  for (int i = 0; i < 4; ++i) history.add(kService, "A", ran(after));
  CHECK(of(history, 1).median == before);
  history.add(kService, "A", ran(after));
  CHECK(of(history, 1).median == after);
  CHECK(of(history, 1).samples == 5);
}

TEST_CASE("a single outlier makes nothing forgotten") {
  History history;
  for (int i = 0; i < 50; ++i) history.add(kService, "A", ran(i % 2 ? 10ms : 100ms));
  CHECK(of(history, 1).samples == History::kNeighbours);
}

TEST_CASE("how long a CSP has not run is counted in decisions for its service") {
  History history;
  history.add(kService, "A", ran(1ms));
  for (int i = 0; i < 7; ++i) history.count(kService, i == 0);
  CHECK(of(history, 1).idle == 7);
  CHECK(history.decisions(kService).made == 7);
  CHECK(history.decisions(kService).explored == 1);
}

TEST_CASE("a history that was saved is loaded the same, bit for bit") {
  History history;
  for (int i = 0; i < 300; ++i) {
    history.add(kService, i % 3 ? "A" : "B",
                ran(Duration(1'000'003 * (i % 7)), 0.1 * i, i % 5 > 0, 1.0 / (i + 1)));
    history.count(kService, i % 11 == 0);
  }
  const File file;
  history.save(file.path);
  const History loaded = History::load(file.path);
  CHECK(loaded == history);
  CHECK(loaded.to_json() == history.to_json());
}

TEST_CASE("without a file the history is empty") {
  CHECK(History::load("no_such_history.json") == History());
}

TEST_CASE("a history that cannot be read is refused with file, place and remedy") {
  const File file;
  const auto write = [&](const std::string& text) { std::ofstream(file.path) << text; };
  write("{\"version\":1,\"csps\":[{\"service\":7");
  CHECK_THROWS_AS(History::load(file.path), InvalidArgument);
  CHECK_THROWS_WITH(History::load(file.path), Catch::Contains(file.path) &&
                                                  Catch::Contains("line 1") &&
                                                  Catch::Contains("remove it"));
  write(
      "{\"version\":1,\"csps\":[{\"service\":7,\"csp\":\"A\",\"surprises\":0,\"runs\":[]}],"
      "\"decisions\":[]}");
  CHECK_THROWS_WITH(History::load(file.path), Catch::Contains("$.csps[0].service"));
  write("{\"version\":2,\"csps\":[],\"decisions\":[]}");
  CHECK_THROWS_WITH(History::load(file.path), Catch::Contains("$.version is 2"));
  CHECK_THROWS_WITH(History().save("no_such_folder/history.json"),
                    Catch::Contains("no_such_folder"));
}
