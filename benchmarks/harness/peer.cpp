#include "harness/peer.hpp"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <sstream>

#include "harness/skipped.hpp"
#include "skein/core/error.hpp"

namespace skein::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;

void say(const std::string& line) { std::cout << line << '\n' << std::flush; }

// The last octet too: a truncated or stale reply differs in it.
Content content_of(std::size_t size, std::size_t turn) {
  Content content(size, static_cast<std::uint8_t>(turn));
  for (std::size_t i = 0; i < size; i += 97) content[i] = static_cast<std::uint8_t>(i / 97 + turn);
  return content;
}

std::string measure(const EchoCall& call, const std::string& what, std::size_t turn) {
  std::istringstream words(what);
  std::size_t size = 0, count = 0;
  words >> size >> count;
  const Content content = content_of(size, turn);
  std::string times = "times";
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = Clock::now();
    const Content reply = call(content);
    const auto took = Clock::now() - begin;
    if (reply != content) throw Internal("a reply differs from what was sent");
    times += ' ' + std::to_string(std::chrono::nanoseconds(took).count());
  }
  return times;
}

std::string one_line(std::string text) {
  for (char& letter : text) letter = letter == '\n' ? ' ' : letter;
  return text;
}

}  // namespace

std::string now_text() {
  return std::to_string(std::chrono::nanoseconds(Clock::now().time_since_epoch()).count());
}

void run_client(const EchoCall& call, const std::vector<std::pair<std::string, Command>>& extra) {
  say("ready " + now_text());
  std::string line;
  for (std::size_t turn = 0; std::getline(std::cin, line); ++turn) {
    const std::size_t space = line.find(' ');
    const std::string name = line.substr(0, space);
    const std::string rest = space == std::string::npos ? "" : line.substr(space + 1);
    if (name == "call") say(measure(call, rest, turn));
    for (const auto& [known, command] : extra) {
      if (name == known) say(command(rest));
    }
  }
}

void run_server() {
  say("ready " + now_text());
  std::string line;
  while (std::getline(std::cin, line)) {
  }
}

int run_peer(const std::function<void()>& peer) {
  try {
    peer();
    return 0;
  } catch (const Skipped& reason) {
    say("skipped " + one_line(reason.what()));
  } catch (const std::exception& error) {
    say("failed " + one_line(error.what()));
  }
  return 1;
}

}  // namespace skein::benchmarks
