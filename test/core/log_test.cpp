#include "core/log.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace skein;

namespace {

/// The lines that reach the sink while it lives, at the default level again afterwards.
struct Sink {
  Sink() {
    set_log_sink([this](const LogLine& line) { texts.emplace_back(line.text); });
  }
  ~Sink() {
    set_log_sink({});
    set_log_level(LogLevel::Info);
  }
  std::vector<std::string> texts;
};

std::uint64_t latest() {
  const auto lines = logged_after(0);
  return lines.empty() ? 0 : lines.back().number;
}

}  // namespace

TEST_CASE("the log drops lines below its level") {
  const Sink sink;
  log(LogLevel::Debug, "place", "a detail");
  log(LogLevel::Info, "place", "news");
  set_log_level(LogLevel::Error);
  CHECK_FALSE(is_logged(LogLevel::Warning));
  log(LogLevel::Warning, "place", "a warning");
  log(LogLevel::Error, "place", "an error");
  CHECK(sink.texts == std::vector<std::string>{"news", "an error"});
}

TEST_CASE("the log keeps the latest lines for readers that come later") {
  const Sink sink;
  const std::uint64_t before = latest();
  for (int i = 0; i < 300; ++i) log(LogLevel::Info, "place", std::to_string(i));
  const auto all = logged_after(0);
  REQUIRE(all.size() == kKeptLines);
  CHECK(all.front().text == std::to_string(300 - kKeptLines));
  CHECK(all.back().number == before + 300);
  const auto news = logged_after(before + 298);
  REQUIRE(news.size() == 2);
  CHECK(news[0].text == "298");
  CHECK(logged_after(before + 300).empty());
  CHECK(logged_after(before + 999).empty());
}
