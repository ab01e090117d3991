// Ctrl-C ends every command within a second, whatever it waits for.
#include <fcntl.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <memory>
#include <thread>

#include "skein/detail/codec.hpp"
#include "skein/entity.hpp"
#include "test/command/mission/errand.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"

using namespace skein::test;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Words = std::vector<std::string>;

namespace {

const std::string kDomain = "117";

/// Of those that look at a domain, each in what its options make it wait for: peers, a name,
/// answers, values, an end.
std::vector<Words> looking_commands() {
  const std::string corner = R"({"x": 1, "y": 2})";
  return {{"call", "ISurveyor", "greet", "\"forever\"", "--wait", "60", "--within", "60"},
          {"call", "INobody", "greet", "\"x\"", "--wait", "60"},
          {"describe", "ISurveyor"},
          {"describe", "corner"},
          {"describe", "corner", "--wait", "60"},
          {"doctor"},
          {"echo", "corner"},
          {"echo", "nothing", "--wait", "60"},
          {"param", "list", "--wait", "60"},
          {"param", "get", "field/nobody", "Rate", "--wait", "60"},
          {"peers", "--wait", "60"},
          {"publish", "plot", R"({"kind": "Wood", "corners": []})", "--rate", "1"},
          {"publish", "plot", "-"},
          {"publish", "nothing", corner, "--wait", "60"},
          {"rate", "corner"},
          {"services", "--wait", "60"},
          {"services", "--statistics"},
          {"top", "--once"},
          {"topics", "--wait", "60"},
          {"view", "--port", "0"},
          {"bench", "latency", "--count", "1000000"},
          {"bench", "throughput", "--count", "1000000"},
          {"bench", "discovery"}};
}

/// Of those that start, check or ask after a mission.
std::vector<Words> mission_commands(const std::string& profile) {
  return {{"check", profile},
          {"doctor", "--profile", profile},
          {"launch", profile},
          {"peer", profile, "client"},  // waits for its dependency
          {"peer", profile, "office"},
          {"status", profile},
          {"restart", profile, "office"},
          {"script", profile, "--output", "start.sh"}};
}

std::string text_of(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += word + " ";
  return text;
}

/// Input that never comes.
class Silence {
 public:
  Silence() { REQUIRE(::pipe2(ends_, O_CLOEXEC) == 0); }
  ~Silence() {
    ::close(ends_[0]);
    ::close(ends_[1]);
  }
  Silence(const Silence&) = delete;
  int reader() const { return ends_[0]; }

 private:
  int ends_[2];
};

/// How long it goes on once it is interrupted.
std::chrono::milliseconds interrupt(const Words& words, std::chrono::milliseconds after) {
  const Silence silence;
  CommandRun run(words, {.prepare = [&] { ::dup2(silence.reader(), STDIN_FILENO); }});
  eventually([&] { return run.wait(0s) >= 0; }, after);  // it may have ended by itself
  const auto begin = Clock::now();
  run.signal(SIGINT);
  const int code = run.wait(10s);
  const auto took = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - begin);
  INFO(text_of(words) << "after " << after.count() << " ms:\n" << run.output());
  CHECK(code >= 0);
  return took;
}

/// One after the other; on a busy machine one that goes on for long has two more tries.
void interrupt_each(const std::vector<Words>& commands, std::chrono::milliseconds after) {
  for (const Words& words : commands) {
    auto took = interrupt(words, after);
    for (int tries = 1; tries < 3 && took >= 1s; ++tries) took = interrupt(words, after);
    INFO(text_of(words) << "after " << after.count() << " ms");
    CHECK(took < 1000ms);
  }
}

}  // namespace

TEST_CASE(
    "Ctrl-C ends each command that looks at a domain within a second, in each of its phases") {
  const std::string vendor = GENERATE(as<std::string>(), "cyclonedds");
  if (!installed(vendor)) return;
  ChildProcess station("station_process", {.arguments = {vendor, kDomain}});
  station.expect("ready");
  const auto after = GENERATE(50ms, 700ms);
  // A peer that is known and does not answer is waited for longest.
  if (after > 100ms) station.signal(SIGSTOP);
  auto commands = looking_commands();
  for (const std::string& command : commands_with("--domain")) commands.push_back({command});
  for (Words& words : commands) {
    words.insert(words.end(), {"--domain", kDomain});
    if (words[0] != "doctor") words.insert(words.end(), {"--vendor", vendor});
  }
  interrupt_each(commands, after);
}

TEST_CASE("Ctrl-C ends each command of a mission within a second") {
  const Errand errand;
  const std::string profile =
      errand.profile("",
                     "<peer name='office' component='office.xml' vendor='cyclonedds'/>"
                     "<peer name='client' component='client.xml' vendor='cyclonedds'/>");
  interrupt_each(mission_commands(profile), GENERATE(50ms, 400ms));
}
