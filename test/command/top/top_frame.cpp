// What `skein top` draws, and what keys do.
#include <algorithm>
#include <catch2/catch.hpp>

#include "command/print/figures.hpp"
#include "command/top/frame.hpp"
#include "command/top/sampler.hpp"
#include "skein/introspection.idl.hpp"

using namespace skein;
using namespace skein::command;
using namespace skein::command::top;
using Catch::Contains;

namespace {

PeerRow peer_row(const std::string& name, double cpu, std::uint64_t memory) {
  return {name, 1234, cpu, memory, 12, 2, "ok"};
}

ServiceRow service(const std::string& name, double calls, std::uint64_t p99) {
  return {name, "uav-1/navigator", calls, 0.0, 0, 1, p99 / 2, p99};
}

Figures some_figures(std::size_t count) {
  Figures figures{"domain 42 on 127.0.0.1", "12:00:00", {}, {}, {}};
  for (std::size_t i = 0; i < count; ++i) {
    const std::string number = std::to_string(i);
    figures.peers.push_back(peer_row("uav-1/peer-" + number, static_cast<double>(i), i << 20));
    figures.services.push_back(
        service("ns/Service" + number, static_cast<double>(i), i * 1'000'000));
    figures.decisions.push_back("decision " + number);
  }
  return figures;
}

std::string text_of(const std::vector<Line>& lines) {
  std::string text;
  for (const Line& line : lines) text += line.text + "\n";
  return text;
}

/// Where each of the parts begins in the text, or npos.
bool before(const std::string& text, const std::string& first, const std::string& second) {
  REQUIRE(text.find(first) != std::string::npos);
  REQUIRE(text.find(second) != std::string::npos);
  return text.find(first) < text.find(second);
}

Key key(const std::string& bytes) {
  std::size_t length = 0;
  const Key found = key_of(bytes, length);
  CHECK(length > 0);
  CHECK(length <= bytes.size());
  return found;
}

}  // namespace

TEST_CASE(
    "a frame is never larger than its screen, however small that is or much there is to show") {
  for (const std::size_t rows : {0, 1, 5, 60}) {
    const Figures figures = some_figures(rows);
    for (const std::size_t height : {1, 2, 5, 10, 24, 100}) {
      for (const std::size_t width : {1, 20, 80, 200}) {
        CAPTURE(rows, height, width);
        const auto lines = draw(figures, {}, width, height);
        CHECK(lines.size() <= height);
        for (const Line& line : lines) CHECK(line.text.size() <= width);
      }
    }
  }
}

TEST_CASE("80 columns and 24 lines show peers, services, decisions and the keys") {
  const auto lines = draw(some_figures(40), {}, 80, 24);
  const std::string text = text_of(lines);
  CHECK(lines.size() == 24);
  for (const char* part :
       {"domain 42 on 127.0.0.1", "40 peers", "PEER", "CPU %", "MEMORY", "uav-1/peer-39", "SERVICE",
        "CALLS/s", "P99", "ns/Service39", "DECISIONS", "decision 39", "q quit"})
    CHECK_THAT(text, Contains(part));
}

TEST_CASE("without a height every row is there, and no keys") {
  const std::string text = text_of(draw(some_figures(60), {}, 80, std::nullopt));
  for (const char* part :
       {"peer-0 ", "peer-59", "Service0 ", "Service59", "decision 0\n", "decision 59\n"})
    CHECK_THAT(text, Contains(part));
  CHECK_THAT(text, !Contains("q quit"));
}

TEST_CASE("few peers leave their room to services") {
  Figures figures = some_figures(30);
  figures.peers.resize(2);
  figures.decisions.clear();
  const std::string text = text_of(draw(figures, {}, 80, 24));
  CHECK(std::ranges::count(text, '/') > 18);
}

TEST_CASE("text of others cannot drive the screen, nor shift its columns") {
  Figures figures = some_figures(1);
  figures.peers[0].name = "x\x1b[2J\xc2\x9b\xe2\x80\xae\xe4\xb8\xad";
  figures.services[0].service = figures.peers[0].name;
  figures.decisions = {figures.peers[0].name};
  for (const Line& line : draw(figures, {}, 120, 24))
    for (const char c : line.text) CHECK((c >= ' ' && c < 127));
}

TEST_CASE("a name that is too long is cut with a mark") {
  Figures figures = some_figures(1);
  figures.peers[0].name = std::string(300, 'x');
  const std::string text = text_of(draw(figures, {}, 80, 24));
  CHECK_THAT(text, Contains("xxx~"));
  CHECK_THAT(text, Contains("1234"));
}

TEST_CASE("a decision is cut with a mark on a screen, and whole as text") {
  Figures figures = some_figures(1);
  figures.decisions = {std::string(100, 'd') + "184 us"};
  CHECK_THAT(text_of(draw(figures, {}, 80, 24)), Contains("ddd~") && !Contains("184"));
  CHECK_THAT(text_of(draw(figures, {}, 80, std::nullopt)), Contains("d184 us"));
}

TEST_CASE("rows are ordered as the keys say, of the pane that is chosen") {
  Figures figures = some_figures(0);
  figures.peers = {peer_row("a", 1, 300), peer_row("b", 3, 200), peer_row("c", 2, 100)};
  figures.services = {service("x", 1, 10), service("y", 2, 5), service("z", 0, 20)};
  const auto drawn = [&](const View& view) { return text_of(draw(figures, view, 80, 24)); };
  View view;
  CHECK(before(drawn(view), "\nb ", "\nc "));
  view = after(view, Key::ByMemory, figures);
  CHECK(before(drawn(view), "\na ", "\nb "));
  CHECK(before(drawn(view), "\ny ", "\nx "));
  view = after(view, Key::ByLatency, figures);
  CHECK(before(drawn(view), "\nz ", "\nx "));
  view = after(view, Key::NextPane, figures);
  view = after(view, Key::ByName, figures);
  CHECK(before(drawn(view), "\nx ", "\ny "));
  CHECK(before(drawn(view), "\na ", "\nb "));
}

TEST_CASE("arrows and page keys scroll, and stop at the ends") {
  const Figures figures = some_figures(40);
  View view;
  view.peers = Order::Name;
  const auto drawn = [&] { return text_of(draw(figures, view, 80, 24)); };
  CHECK_THAT(drawn(), Contains("peer-0 "));
  view = after(view, Key::Up, figures);
  CHECK(view.first_peer == 0);
  view = after(view, Key::Down, figures);
  CHECK_THAT(drawn(), !Contains("peer-0 "));
  for (int i = 0; i < 10; ++i) view = after(view, Key::PageDown, figures);
  CHECK_THAT(drawn(), Contains("peer-9 "));
  for (int i = 0; i < 10; ++i) view = after(view, Key::PageUp, figures);
  CHECK_THAT(drawn(), Contains("peer-0 "));
  view = after(after(view, Key::NextPane, figures), Key::Down, figures);
  CHECK(view.first_service == 1);
  CHECK(after(View(), Key::Down, some_figures(0)).first_peer == 0);
}

TEST_CASE("keys are read from what terminals send, whole or in part") {
  CHECK(key("\x1b[A") == Key::Up);
  CHECK(key("\x1bOB") == Key::Down);
  CHECK(key("\x1b[6~") == Key::PageDown);
  CHECK(key("q") == Key::Quit);
  CHECK(key("\t") == Key::NextPane);
  CHECK(key("\x1b[1;5Dq") == Key::None);
  CHECK(key("\x1b") == Key::None);
  CHECK(key("\x1b[") == Key::None);
  CHECK(key("\xff") == Key::None);
  std::size_t length = 0;
  key_of("\x1b[1;5Dq", length);
  CHECK(length == 6);
}

TEST_CASE("CPU is what a process used between two answers, by its own clock") {
  DomainPicture picture(1);
  picture[0].name = "uav-1/navigator";
  picture[0].process.emplace();
  picture[0].process->time = 1'000'000'000;
  picture[0].process->cpu = 100'000'000;
  Rates rates;
  CHECK(!rates.peers(picture)[0].cpu);
  picture[0].process->time = 3'000'000'000;
  picture[0].process->cpu = 600'000'000;
  CHECK(rates.peers(picture)[0].cpu == Approx(25));
  CHECK(!rates.peers(picture)[0].cpu);
  picture[0].process.reset();
  CHECK(rates.peers(picture)[0].state == "silent");
}

TEST_CASE("calls a second come of two tellings, and hold until the next") {
  introspection::ServiceStatistics service;
  service.service = "crew/Desk";
  service.operations.resize(2);
  service.operations[0].received = 10;
  service.operations[0].ran.p99 = 500;
  service.operations[1].ran.p99 = 900;
  Rates rates;
  constexpr std::uint64_t kSecond = 1'000'000'000;
  auto row = rates.services({service}, 0)[0];
  CHECK(!row.calls);
  CHECK(row.p99 == 900);
  service.operations[0].received = 20;
  service.operations[1].received = 30;
  service.operations[1].refused = 2;
  row = rates.services({service}, 2 * kSecond)[0];
  CHECK(row.calls == Approx(20));
  CHECK(row.failed == Approx(1));
  row = rates.services({service}, 2 * kSecond + kSecond / 10)[0];
  CHECK(row.calls == Approx(20));
  row = rates.services({service}, 4 * kSecond)[0];
  CHECK(row.calls == Approx(0));
}

TEST_CASE("a decision in a line names who was tried and what became of it") {
  introspection::Decision decision;
  decision.entity = "uav-1/navigator";
  decision.request = "hurry";
  decision.attempts.resize(2);
  decision.attempts[0].csp = "AStar";
  decision.attempts[1].csp = "RRTConnect";
  decision.took = 18'000'000;
  CHECK_THAT(line_of(decision),
             Contains("uav-1/navigator hurry: AStar, RRTConnect answered after 18 ms"));
  decision.failure = "nobody in time";
  CHECK_THAT(line_of(decision), Contains("failed after 18 ms"));
  decision.attempts.clear();
  CHECK_THAT(line_of(decision), Contains("nobody failed"));
}

TEST_CASE("figures take few characters, with the unit that fits") {
  CHECK(short_time(350'000) == "350 us");
  CHECK(short_time(4'210'000) == "4.2 ms");
  CHECK(short_time(12'000'000'000) == "12 s");
  CHECK(short_time(7'200'000'000'000) == "2 h");
  CHECK(short_size(800) == "800 B");
  CHECK(short_size(34 << 20) == "34 MiB");
  CHECK(short_size(std::uint64_t(1288490189)) == "1.2 GiB");
  CHECK(short_number(0) == "0");
  CHECK(short_number(9.96) == "10");
}
