#include "core/latency_histogram.hpp"

#include <catch2/catch.hpp>
#include <thread>
#include <vector>

using namespace skein;
using namespace std::chrono_literals;

TEST_CASE("a histogram without entries has a summary of zeros") {
  const LatencySummary summary = LatencyHistogram().summary();
  CHECK(summary.count == 0);
  CHECK(summary.p99 == 0ns);
  CHECK(summary.greatest == 0ns);
}

TEST_CASE(
    "one duration is every percentile, at most an eighth too high and never above the greatest") {
  const auto duration =
      GENERATE(0ns, 1ns, 15ns, 16ns, 17ns, 255ns, 256ns, 1'000ns, 999'999ns, 60'000'000'000ns);
  LatencyHistogram histogram;
  histogram.record(duration);
  const LatencySummary summary = histogram.summary();
  CHECK(summary.p50 == duration);
  CHECK(summary.p99 == duration);
  CHECK(summary.mean == duration);
  histogram.record(duration * 100);
  CHECK(histogram.summary().p50 >= duration);
  CHECK(histogram.summary().p50 <= duration + duration / 8);
}

TEST_CASE("percentiles of a thousand durations are at most an eighth too high") {
  LatencyHistogram histogram;
  for (int i = 1; i <= 1000; ++i) histogram.record(i * 1us);
  const LatencySummary summary = histogram.summary();
  const auto check = [](Duration seen, Duration expected) {
    CHECK(seen >= expected);
    CHECK(seen <= expected + expected / 8);
  };
  CHECK(summary.count == 1000);
  check(summary.p50, 500us);
  check(summary.p90, 900us);
  check(summary.p99, 990us);
  CHECK(summary.greatest == 1ms);
  CHECK(summary.mean == 500'500ns);
}

TEST_CASE("what is out of range is counted at its end") {
  LatencyHistogram histogram;
  histogram.record(-5ns);
  histogram.record(100h);
  const LatencySummary summary = histogram.summary();
  CHECK(summary.count == 2);
  CHECK(summary.p50 == 0ns);
  CHECK(summary.greatest > 15min);
}

TEST_CASE("nothing is lost when several threads record") {
  LatencyHistogram histogram;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      for (int j = 0; j < 10'000; ++j) histogram.record(j * 1ns);
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(histogram.summary().count == 40'000);
}
