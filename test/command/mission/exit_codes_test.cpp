// The table of exit codes: for each code a command that ends with it.
#include "mission/process/exit_codes.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <charconv>
#include <csignal>
#include <set>

#include "errand.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"

using namespace skein;
using namespace skein::test;
using Words = std::vector<std::string>;

namespace {

constexpr int kInterruptedBySigint = 128 + SIGINT;
constexpr int kOfTheMission = 3;  // what `page` ends with

/// The code that stands for a row.
int example_of(const launch::ExitCode& row) {
  if (row.code == "128 + N") return kInterruptedBySigint;
  if (row.code == "1 to 255") return kOfTheMission;
  int code = -1;
  std::from_chars(row.code.data(), row.code.data() + row.code.size(), code);
  return code;
}

class Table {
 public:
  /// Runs the command, and sends it SIGINT once it says `until`.
  void expect(int code, const Words& words, const CommandOptions& options = {},
              const std::string& until = "") {
    CAPTURE(words);
    CommandRun run(words, options);
    if (!until.empty()) {
      REQUIRE(run.writes(until));
      run.signal(SIGINT);
    }
    const int ended_with = run.wait();
    CAPTURE(run.output());
    CHECK(ended_with == code);
    shown_.insert(ended_with);
  }

  void demand_all() const {
    for (const launch::ExitCode& row : launch::kExitCodes) {
      CAPTURE(std::string(row.code), std::string(row.meaning));
      CHECK(shown_.contains(example_of(row)));
    }
  }

 private:
  std::set<int> shown_;
};

}  // namespace

TEST_CASE("each exit code of the table has its cause") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  const Errand errand;
  const std::string office = "<peer name='office' component='office.xml'/>";
  const std::string client = "<peer name='client' component='client.xml' role='mission'/>";
  const auto thrower = [](const std::string& policy) {
    return "<peer name='thrower' component='thrower.xml' on_loss='" + policy + "'/>";
  };
  Table table;

  table.expect(0, {"--version"});
  table.expect(0, {"completion", "bash"});
  const std::string recording = (errand.path() / "empty.mcap").string();
  table.expect(
      69, {"record", "--only-topics", "--for", "0.2", "--domain", "49", "--output", recording});
  table.expect(1, {"info", recording});
  table.expect(2, {"doctor", errand.write("broken.xml", "<mission")});

  const std::string whole = errand.profile("", office + client);
  for (const Words& words : {Words{"--verison"},
                             {"stop"},
                             {"nothing"},
                             {"bench", "nothing"},
                             {"echo"},
                             {"echo", "pose", "--count", "0"},
                             {"graph", "--format", "pdf"},
                             {"completion", "tcsh"},
                             {"launch", whole, "--set", "lift=3"},
                             {"launch", whole, "--variable", "lift"},
                             {"restart"}}) {
    table.expect(launch::kUsageError, words);
  }

  for (const Words& words : {Words{"describe", "Nothing", "--wait", "0.1"},
                             {"call", "Nothing", "ask", "--wait", "0.1"},
                             {"echo", "nothing", "--wait", "0.1"},
                             {"param", "get", "nobody", "Period", "--wait", "0.1"}}) {
    Words there = words;
    there.insert(there.end(), {"--domain", "49"});
    table.expect(launch::kNothingThere, there);
  }

  const std::string nowhere = "/no/such/folder/file";
  table.expect(launch::kOutputLost, {"script", whole, "--output", nowhere});
  table.expect(launch::kOutputLost, {"record", "--domain", "49", "--output", nowhere});
  table.expect(launch::kOutputLost,
               {"record", "--domain", "49", "--output", recording});  // it is there
  table.expect(launch::kOutputLost, {"--help"}, {.output = "/dev/full"});

  table.expect(launch::kConfigurationError, {"check", "nowhere.xml"});
  table.expect(launch::kConfigurationError, {"launch", whole, "--set", "office.Nothing=3"});
  table.expect(launch::kConfigurationError, {"info", "nowhere.mcap"});

  table.expect(launch::kStartFailed, {"status", whole});
  table.expect(launch::kStartFailed,
               {"launch", "--no-log",
                errand.profile("", "<peer name='sick' component='sick.xml' on_loss='abort'/>")});
  table.expect(launch::kPeerLost,
               {"launch", "--no-log", errand.profile("", office + thrower("abort"))});
  table.expect(launch::kDegraded,
               {"launch", "--no-log", errand.profile("", office + thrower("degrade") + client)});
  table.expect(launch::kMissionFailed,
               {"launch", "--no-log",
                errand.profile("", "<peer name='clumsy' component='clumsy.xml' role='mission'/>")});
  table.expect(kOfTheMission,
               {"launch", "--no-log",
                errand.profile("",
                               "<peer name='herald' component='herald.xml'/>"
                               "<peer name='page' component='page.xml' role='mission'/>")});
  table.expect(kInterruptedBySigint,
               {"launch", "--verbose", "--no-log", errand.profile("", office)}, {},
               "office: ready");

  const CommandRun desk({"launch", "--verbose", "--no-log",
                         errand.profile("",
                                        "<peer name='office' component='office.xml' "
                                        "stop_timeout='100 ms'/>")});
  REQUIRE(desk.writes("office: ready"));
  table.expect(launch::kNoAnswer,
               {"call", "Desk", "ask", "\"spin\"", "--within", "200ms", "--domain", "48"});

  table.demand_all();
}
