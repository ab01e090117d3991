// The commands that speak to a running peer, and those that read what was recorded of it: what they
// print, how they end, and that nothing holds them up. What depends on the vendor is seen against a
// station of each.
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/system/file_descriptor.hpp"
#include "other_corner.idl.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/entity.hpp"
#include "skein/introspection.idl.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein;
using namespace skein::test;
using Catch::Contains;
using Catch::StartsWith;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

namespace {

const std::string kPlot = R"({"kind": "Wood", "corners": [{"x": 1, "y": 2}, {"x": 3, "y": 4}]})";
const std::string kNoPlot = R"({"kind": "Wood", "corners": []})";

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A command of which stdout and stderr are told apart.
class Command {
 public:
  explicit Command(const Words& words, CommandOptions options = {})
      : run_(words, with_own_output(std::move(options))) {}

  std::string printed() const { return text_of(run_.folder() / "printed"); }
  std::string said() const { return run_.output(); }
  Json json() const { return Json::parse(printed()); }
  std::vector<Json> json_lines() const {
    std::vector<Json> values;
    std::istringstream lines(printed());
    for (std::string line; std::getline(lines, line);) values.push_back(Json::parse(line));
    return values;
  }
  bool prints(const std::string& part) const {
    return eventually([&] { return printed().find(part) != std::string::npos; });
  }
  bool says(const std::string& part) const { return run_.writes(part); }
  void signal(int number) const { run_.signal(number); }
  int code() { return run_.wait(); }

 private:
  static CommandOptions with_own_output(CommandOptions options) {
    options.output = "printed";  // in its folder
    return options;
  }

  CommandRun run_;
};

/// A station on a domain of its own, and commands that look at it.
class Field {
 public:
  explicit Field(const std::string& vendor)
      : place_{"--domain", std::to_string(next_domain()), "--vendor", vendor},
        station_("station_process", {.arguments = {vendor, place_[1]}}) {
    station_.expect("ready");
  }

  ChildProcess& station() { return station_; }
  std::uint32_t domain() const { return static_cast<std::uint32_t>(std::stoul(place_[1])); }

  Command start(const Words& words, CommandOptions options = {}) const {
    Words all = words;
    all.insert(all.end(), place_.begin(), place_.end());
    return Command(all, std::move(options));
  }

 private:
  static int next_domain() {
    static int domain = 100;
    return ++domain;
  }

  Words place_;
  ChildProcess station_;
};

/// A pipe into a command's standard input.
class Input {
 public:
  Input() {
    int ends[2];
    REQUIRE(pipe2(ends, O_CLOEXEC) == 0);
    reader_ = FileDescriptor(ends[0]);
    writer_ = FileDescriptor(ends[1]);
  }

  CommandOptions options() const {
    return {.prepare = [reader = reader_.get()] { dup2(reader, STDIN_FILENO); }};
  }
  void write(const std::string& text) const {
    REQUIRE(::write(writer_.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  void end() { writer_.reset(); }

 private:
  FileDescriptor reader_;
  FileDescriptor writer_;
};

/// A folder for recordings.
struct Shelf : TemporaryFolder {
  std::string operator/(const std::string& name) const { return (path() / name).string(); }
};

/// Lists are taken of what is known after a while: repeats the command until it succeeds and
/// prints or says `part`. Null where it never does.
std::unique_ptr<Command> that_tells(const Field& field, const Words& words,
                                    const std::string& part) {
  std::unique_ptr<Command> command;
  const bool told = eventually([&] {
    command.reset(new Command(field.start(words)));
    return command->code() == 0 &&
           (command->printed() + command->said()).find(part) != std::string::npos;
  });
  return told ? std::move(command) : nullptr;
}

std::string any_vendor() { return GENERATE(as<std::string>(), "fastdds", "cyclonedds"); }

/// For what does not depend on the vendor: arguments, what is printed, files.
const std::string kOneVendor = "cyclonedds";

}  // namespace

TEST_CASE("two programs with an entity of one name are both warned") {
  const std::string vendor = any_vendor();
  if (!installed(vendor)) return;
  const Field field(vendor);
  ChildProcess second("station_process", {.arguments = {vendor, std::to_string(field.domain())}});
  second.expect("ready");
  Command log = field.start({"log", "--json"});
  const std::string warning = " runs an entity of the same name: ";
  REQUIRE(eventually([&] {
    std::set<int> warned;
    for (const Json& line : log.json_lines()) {
      if (line["text"].get<std::string>().find(warning) != std::string::npos)
        warned.insert(line["pid"].get<int>());
    }
    return warned.size() == 2;
  }));
  log.signal(SIGINT);
  CHECK(log.code() == 0);
}

TEST_CASE("log shows what a process has logged before, and what it logs from then on") {
  const std::string vendor = any_vendor();
  if (!installed(vendor)) return;
  const Field field(vendor);
  const auto greet = [&](const std::string& name) {
    Command call = field.start({"call", "ISurveyor", "greet", '"' + name + '"', "--wait", "20"});
    CHECK(call.code() == 0);
  };
  greet("early");
  Command log = field.start({"log", "--entity", "station"});
  REQUIRE(log.prints("field/station info: greeter: greets early\n"));
  greet("late");
  REQUIRE(log.prints("field/station info: greeter: greets late\n"));
  Command errors = field.start({"log", "--level", "error", "--for", "2"});
  Command misspelt = field.start({"log", "--entity", "staton", "--for", "4"});
  Command json = field.start({"log", "--json"});
  REQUIRE(json.prints("greets late"));
  CHECK(json.json_lines().front()["level"] == "Info");
  CHECK(errors.code() == 0);
  CHECK(errors.printed().empty());
  CHECK(misspelt.code() == 0);
  CHECK_THAT(misspelt.said(), Contains("no line of 'staton' has come (did you mean 'station'?)"));
  log.signal(SIGINT);
  CHECK(log.code() == 0);
  const std::string all = log.printed();
  CHECK(all.find("greets early") == all.rfind("greets early"));
}

TEST_CASE("call prints what an operation returns") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Field field(vendor);
  const auto call = [&](const std::string& operation, const std::string& arguments,
                        const Words& more = {}) {
    Words words{"call", "ISurveyor", operation, arguments, "--wait", "20", "--within", "20s"};
    words.insert(words.end(), more.begin(), more.end());
    return field.start(words);
  };
  SECTION("as text") {
    Command greet = call("greet", "\"world\"");
    CHECK(greet.code() == 0);
    CHECK(greet.printed() == "\"Hello, world\"\n");
    CHECK(greet.said().empty());
  }
  SECTION("as JSON, with out parameters beside the result") {
    Command measure = call("measure", "{\"plot\": " + kPlot + "}", {"--json"});
    CHECK(measure.code() == 0);
    CHECK(measure.json()["return_"]["area"] == 2.5);
    CHECK(measure.json()["corners"] == 2);
  }
  SECTION("each result of a stream") {
    Command walk = call("walk", "3", {"--json"});
    CHECK(walk.code() == 0);
    REQUIRE(walk.json_lines().size() == 3);
    CHECK(walk.json_lines().back() == Json{{"x", 2}, {"y", 0.5}});
  }
  SECTION("nothing of an operation that returns nothing") {
    Command text = call("forget", "{}");
    CHECK(text.code() == 0);
    CHECK(text.printed().empty());
    Command json = call("forget", "{}", {"--json"});
    CHECK(json.code() == 0);
    CHECK(json.json() == Json::object());
  }
  SECTION("a declared exception, with exit code 1") {
    Command measure = call("measure", "{\"plot\": " + kNoPlot + "}");
    CHECK(measure.code() == 1);
    CHECK(measure.printed().empty());
    CHECK(measure.said() ==
          "skein: ISurveyor.measure raised survey::NoPlot "
          "{\"why\":\"it has no corner\",\"kind\":\"Wood\"}\n");
  }
}

TEST_CASE("call tells of a wrong name, and of arguments that do not fit") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Field field(vendor);
  Command service = field.start({"call", "ISurveyr", "greet", "\"world\"", "--wait", "2"});
  Command operation = field.start({"call", "ISurveyor", "gret", "\"world\"", "--wait", "20"});
  Command arguments = field.start({"call", "ISurveyor", "greet", "7", "--wait", "20"});
  CHECK(service.code() == 69);
  CHECK_THAT(service.said(), Contains("did you mean 'ISurveyor'?"));
  CHECK(operation.code() == 78);
  CHECK_THAT(operation.said(), Contains("did you mean 'greet'?"));
  CHECK(arguments.code() == 78);
  CHECK_THAT(arguments.said(), Contains("$.name is no text"));
}

TEST_CASE("call ends with whom it waits for, at its timeout, and when it is interrupted") {
  const std::string vendor = any_vendor();
  if (!installed(vendor)) return;
  Field field(vendor);
  const auto call_forever = [&](const std::string& within) {
    return field.start(
        {"call", "ISurveyor", "greet", "\"forever\"", "--wait", "20", "--within", within});
  };
  SECTION("interrupted") {
    Command call = call_forever("1h");
    field.station().expect("inside");
    call.signal(SIGINT);
    CHECK(call.code() == 128 + SIGINT);
  }
  SECTION("the provider is killed") {
    Command call = call_forever("1h");
    field.station().expect("inside");
    field.station().signal(SIGKILL);
    CHECK(call.code() == 69);
    CHECK_THAT(call.said(), Contains("its process ended"));
  }
  SECTION("the provider is stopped") {
    Command call = call_forever("1h");
    field.station().expect("inside");
    field.station().signal(SIGSTOP);
    CHECK(call.code() == 69);
    CHECK_THAT(call.said(), Contains("not heard of for longer than its lease"));
  }
  SECTION("there is no answer in time") {
    Command call = call_forever("300ms");
    CHECK(call.code() == 124);
    CHECK_THAT(call.said(), Contains("did not answer 'greet' before its deadline") &&
                                Contains("; --within DURATION sets a longer limit"));
  }
}

TEST_CASE("describe prints the IDL of a service and of a topic") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Field field(vendor);
  const auto service = that_tells(field, {"describe", "ISurveyor"}, "interface ISurveyor");
  REQUIRE(service);
  Command topic = field.start({"describe", "corner"});
  Command json = field.start({"describe", "ISurveyor", "--json"});
  Command wrong = field.start({"describe", "ISurveyr"});
  CHECK_THAT(service->printed(), Contains("module survey {") &&
                                     Contains("  string greet(in string name);\n") &&
                                     Contains("raises (NoPlot)"));
  CHECK(topic.code() == 0);
  CHECK_THAT(topic.printed(), Contains("@final struct Corner {\n  double x;\n  double y;\n};\n"));
  CHECK(json.code() == 0);
  CHECK(json.json()["interfaces"][0]["name"] == "survey::ISurveyor");
  CHECK(json.json()["interfaces"][0]["operations"].size() == 4);
  CHECK(wrong.code() == 69);
  CHECK_THAT(wrong.said(), Contains("did you mean 'ISurveyor'?") && Contains("`skein services`"));
}

TEST_CASE("topics lists who publishes and subscribes to what") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Field field(vendor);
  const auto text = that_tells(field, {"topics"}, "2 topics");
  REQUIRE(text);
  Command json = field.start({"topics", "--json"});
  CHECK_THAT(text->printed(),
             Contains("survey::Corner  in field\n    published by  field/station"));
  CHECK_THAT(text->printed(), Contains("survey::Plot  in field\n    subscribed by field/station"));
  CHECK(json.code() == 0);
  REQUIRE(json.json().size() == 2);
  CHECK(json.json()[0]["name"] == "corner");
  CHECK(json.json()[0]["type"] == "survey::Corner");
  CHECK(json.json()[0]["endpoints"][0]["entity"] == "field/station");
  CHECK(json.json()[0]["endpoints"][0]["publishes"] == true);
  CHECK(json.json()[1]["endpoints"][0]["publishes"] == false);
  Command names = field.start({"topics", "--names"});
  CHECK(names.code() == 0);
  CHECK(names.printed() == "corner\nplot\n");
}

TEST_CASE(
    "where a subscription has another version of a type, that is told, and the publisher's is "
    "shown") {
  const std::string vendor = any_vendor();
  if (!installed(vendor)) return;
  const Field field(vendor);
  Entity stranger({.name = "a-stranger",  // answers before the station
                   .system = "field",
                   .vendor = dds::load_vendor(vendor),
                   .domain = field.domain()});
  const auto subscription = stranger.subscription<survey::Corner>("corner");
  const std::string conflict =
      "topic 'corner': field/station, which publishes, and field/a-stranger, which subscribes, "
      "have different versions of survey::Corner";
  const auto topics = that_tells(field, {"topics"}, conflict);
  REQUIRE(topics);
  CHECK_THAT(topics->printed(), Contains(conflict));
  const auto echo = that_tells(field, {"echo", "corner", "--count", "3", "--json"}, conflict);
  REQUIRE(echo);
  CHECK(echo->json_lines().at(0)["y"] == 0.5);
  CHECK_THAT(echo->said(), Contains(conflict) && !Contains("were no survey::Corner"));
  const auto describe = that_tells(field, {"describe", "corner"}, conflict);
  REQUIRE(describe);
  CHECK_THAT(describe->printed(), Contains("double y;") && !Contains("long"));
  CHECK_THAT(describe->said(), Contains(conflict));
}

TEST_CASE("what listens before it prints is cut short when it is interrupted") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Field field(vendor);
  Command topics = field.start({"topics", "--wait", "3600"});
  Command describe = field.start({"describe", "ISurveyr", "--wait", "3600"});
  const auto is_there = [&](const std::string& name) {
    Command peers = field.start({"peers", "--wait", "0.5"});
    return peers.code() == 0 && peers.printed().find(name) != std::string::npos;
  };
  REQUIRE(eventually([&] { return is_there("skein-topics") && is_there("skein-describe"); }));
  topics.signal(SIGINT);
  describe.signal(SIGINT);
  CHECK(topics.code() == 0);
  CHECK_THAT(topics.printed(), Contains("topics in domain"));
  CHECK(describe.code() == 69);
}

TEST_CASE("what lists is not held up by a station that is stopped or killed") {
  const std::string vendor = any_vendor();
  if (!installed(vendor)) return;
  Field field(vendor);
  field.station().signal(GENERATE(SIGSTOP, SIGKILL));
  Command topics = field.start({"topics"});
  Command describe = field.start({"describe", "corner"});
  CHECK(topics.code() == 0);
  CHECK_THAT(topics.printed(), StartsWith("0 topics in domain "));
  CHECK(describe.code() == 69);
}

TEST_CASE("echo prints values as they come, and says by its exit code where too few came") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Field field(vendor);
  Command text = field.start({"echo", "corner", "--count", "2", "--wait", "20"});
  Command json = field.start({"echo", "corner", "--count", "3", "--wait", "20", "--json"});
  Command few = field.start({"echo", "plot", "--count", "1", "--for", "0.5", "--wait", "20"});
  Command none = field.start({"echo", "plot", "--for", "0.5", "--wait", "20"});
  Command wrong = field.start({"echo", "cornr", "--wait", "2"});
  CHECK(text.code() == 0);
  CHECK_THAT(text.printed(), Contains("\n  \"y\": 0.5\n}\n---\n{\n"));
  CHECK(json.code() == 0);
  REQUIRE(json.json_lines().size() == 3);
  CHECK(json.json_lines()[0]["y"] == 0.5);
  CHECK(few.code() == 1);
  CHECK(none.code() == 0);
  CHECK(wrong.code() == 69);
  CHECK_THAT(wrong.said(), Contains("did you mean 'corner'?") && Contains("corner, plot"));
}

TEST_CASE("rate prints a line a second") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Field field(vendor);
  Command text = field.start({"rate", "corner", "--count", "1", "--wait", "20"});
  Command json = field.start({"rate", "corner", "--count", "2", "--wait", "20", "--json"});
  Command wrong = field.start({"rate", "cornr", "--wait", "2"});
  CHECK(text.code() == 0);
  CHECK_THAT(text.printed(), Contains(" values/s  ") && Contains(" bytes/s"));
  CHECK(json.code() == 0);
  REQUIRE(json.json_lines().size() == 2);
  CHECK(json.json_lines()[1]["values_per_second"] > 0);
  CHECK(json.json_lines()[1]["interval_ms"]["mean"] > 0);
  CHECK(wrong.code() == 69);
  CHECK_THAT(wrong.said(), Contains("did you mean 'corner'?"));
}

TEST_CASE("what watches a topic goes on without its publisher, until it is interrupted") {
  const std::string vendor = any_vendor();
  if (!installed(vendor)) return;
  Field field(vendor);
  Command echo = field.start({"echo", "corner", "--wait", "20"});
  Command rate = field.start({"rate", "corner", "--wait", "20"});
  REQUIRE(echo.prints("---"));
  REQUIRE(rate.prints("values/s"));
  SECTION("while it publishes") {}
  SECTION("where it is stopped") { field.station().signal(SIGSTOP); }
  SECTION("where it is killed") {
    field.station().signal(SIGKILL);
    CHECK(rate.prints("\n0.0 values/s  0 bytes/s\n"));
  }
  echo.signal(SIGINT);
  rate.signal(SIGINT);
  CHECK(echo.code() == 0);
  CHECK(rate.code() == 0);
}

TEST_CASE("who waits for a topic that does not come is interrupted by a signal") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Field field(vendor);
  const std::string name = GENERATE("echo", "rate", "publish");
  Words words{name, "nowhere", "--wait", "3600"};
  if (name == "publish") words.push_back(kPlot);
  Command waits = field.start(words);
  REQUIRE(eventually([&] {
    Command peers = field.start({"peers", "--wait", "0.5"});
    return peers.code() == 0 && peers.printed().find("skein-" + name) != std::string::npos;
  }));
  waits.signal(SIGINT);
  CHECK(waits.code() == 128 + SIGINT);
  CHECK_THAT(waits.said(), Contains("interrupted while it looked for the topic 'nowhere'"));
}

TEST_CASE("publish publishes a value, and says to how many") {
  const std::string vendor = any_vendor();
  if (!installed(vendor)) return;
  Field field(vendor);
  Command text = field.start({"publish", "plot", kPlot, "--wait", "20"});
  CHECK(text.code() == 0);
  CHECK(text.printed() == "published 1 value to 1 subscriber\n");
  CHECK(field.station().expect("heard") == "2");
  Command json = field.start({"publish", "plot", kNoPlot, "--count", "2", "--json"});
  CHECK(json.code() == 0);
  CHECK(json.json() == Json{{"published", 2}, {"subscribers", 1}, {"acknowledged", true}});
  CHECK(field.station().expect("heard") == "0");
  Command topic = field.start({"publish", "plt", kPlot, "--wait", "2"});
  Command value =
      field.start({"publish", "plot", R"({"kind": "Wod", "corners": []})", "--wait", "20"});
  CHECK(topic.code() == 69);
  CHECK_THAT(topic.said(), Contains("did you mean 'plot'?"));
  CHECK(value.code() == 78);
  CHECK_THAT(value.said(), Contains("did you mean 'Wood'?"));
}

TEST_CASE("an interrupted publish ends with the signal's code, unless that is the end meant") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  Field field(vendor);
  Command endless = field.start({"publish", "plot", kPlot, "--rate", "20", "--wait", "20"});
  field.station().expect("heard");
  endless.signal(SIGINT);
  CHECK(endless.code() == 0);
  CHECK_THAT(endless.printed(), Contains("published "));
  Command counted = field.start(
      {"publish", "plot", kNoPlot, "--rate", "20", "--count", "100000", "--wait", "20", "--json"});
  REQUIRE(eventually([&] { return field.station().expect("heard") == "0"; }));
  counted.signal(SIGTERM);
  CHECK(counted.code() == 128 + SIGTERM);
  CHECK(counted.json()["published"] > 0);
  CHECK_THAT(counted.said(), Contains("interrupted before all was published"));
}

TEST_CASE("publish ends where its subscriber is stopped or killed") {
  const std::string vendor = any_vendor();
  if (!installed(vendor)) return;
  Field field(vendor);
  Input input;
  Command publish = field.start({"publish", "plot", "-", "--wait", "20"}, input.options());
  input.write(kPlot + "\n");
  field.station().expect("heard");
  SECTION("stopped: it is given up") {
    field.station().signal(SIGSTOP);
    input.write(kPlot + "\n");
    input.end();
    // Its lease may run out before or after the patience for what it is to acknowledge.
    const int code = publish.code();
    CHECK((code == 0 || code == 69));
    CHECK_THAT(publish.printed(), Contains("published 2 values to "));
  }
  SECTION("killed: there is nobody to wait for") {
    field.station().signal(SIGKILL);
    input.write(kPlot + "\n");
    input.end();
    CHECK(publish.code() == 0);
    CHECK_THAT(publish.printed(), Contains("published 2 values to "));
  }
}

TEST_CASE("publish takes each line of its standard input when it comes") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  Field field(vendor);
  Input input;
  Command publish = field.start({"publish", "plot", "-", "--wait", "20"}, input.options());
  SECTION("several at once, with nothing behind them for now") {
    input.write(kPlot + "\n\n" + kNoPlot + "\r\n" + kPlot + "\n");
    CHECK(field.station().expect("heard") == "2");
    CHECK(field.station().expect("heard") == "0");
    CHECK(field.station().expect("heard") == "2");
    input.end();
    CHECK(publish.code() == 0);
    CHECK(publish.printed() == "published 3 values to 1 subscriber\n");
  }
  SECTION("a line of any length") {
    constexpr std::size_t kCorners = 20'000;
    Json plot = Json::parse(kPlot);
    plot["corners"] = Json(kCorners, plot["corners"][0]);
    input.write(plot.dump() + "\n");
    CHECK(field.station().expect("heard") == std::to_string(kCorners));
    input.end();
    CHECK(publish.code() == 0);
  }
  SECTION("the last without a line break") {
    input.write(kNoPlot + "\n" + kPlot);
    CHECK(field.station().expect("heard") == "0");
    input.end();
    CHECK(field.station().expect("heard") == "2");
    CHECK(publish.code() == 0);
  }
  SECTION("one in two pieces") {
    input.write(kNoPlot + "\n" + kPlot.substr(0, 10));
    CHECK(field.station().expect("heard") == "0");
    input.write(kPlot.substr(10) + "\n");
    CHECK(field.station().expect("heard") == "2");
    publish.signal(SIGINT);
    CHECK(publish.code() == 128 + SIGINT);
  }
  SECTION("a piece of one is no reason not to be interrupted") {
    input.write(kNoPlot + "\n" + kPlot.substr(0, 10));
    CHECK(field.station().expect("heard") == "0");
    publish.signal(SIGINT);
    CHECK(publish.code() == 128 + SIGINT);
    CHECK(publish.printed() == "published 1 value to 1 subscriber\n");
  }
}

TEST_CASE("what is recorded can be looked into, exported, and replayed") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Shelf shelf;
  const std::string file = shelf / "flight.mcap";
  {
    Field field(vendor);
    Command publish = field.start({"publish", "plot", kPlot, "--rate", "20", "--wait", "20"});
    field.station().expect("heard");
    Command record = field.start({"record", "--output", file, "--json"});
    REQUIRE(record.says("topic plot (survey::Plot)"));
    REQUIRE(record.says("topic corner (survey::Corner)"));
    field.station().expect("heard");
    Command call = field.start({"call", "ISurveyor", "greet", "\"world\"", "--wait", "20"});
    CHECK(call.code() == 0);
    REQUIRE(eventually([&] {
      Command info({"info", file, "--json"});
      return info.code() == 0 && info.printed().find("\"survey::Plot\"") != std::string::npos;
    }));
    publish.signal(SIGINT);
    CHECK(publish.code() == 0);
    record.signal(SIGINT);
    REQUIRE(record.code() == 0);
    CHECK(record.json()["files"] == Json{file});
    CHECK(record.json()["messages"] > 0);
    CHECK(record.json()["bytes"] == std::filesystem::file_size(file));
    CHECK(record.json()["dropped"] == 0);
  }

  SECTION("info") {
    Command text({"info", file});
    Command json({"info", file, "--json"});
    CHECK(text.code() == 0);
    CHECK_THAT(text.printed(), Contains("survey::Plot") && Contains(" messages\n"));
    CHECK(json.code() == 0);
    const Json described = json.json();
    CHECK(described["complete"] == true);
    CHECK(std::ranges::any_of(described["channels"], [](const Json& channel) {
      return channel["topic"] == "plot" && channel["schema"] == "survey::Plot" &&
             channel["messages"] > 0 && channel["dropped"] == 0;
    }));
  }
  SECTION("export") {
    Command text({"export", file, "--perfetto", shelf / "a.json"});
    Command json({"export", file, "--perfetto", shelf / "b.json", "--json"});
    CHECK(text.code() == 0);
    CHECK_THAT(text.printed(), Contains("a.json: ") && Contains(" events of calls, 0 dec"));
    CHECK(json.code() == 0);
    CHECK(json.json()["file"] == shelf / "b.json");
    CHECK(json.json()["events"] > 0);
    CHECK(json.json()["malformed"] == 0);
    CHECK(text_of(shelf / "a.json") == text_of(shelf / "b.json"));
    // What is there stays, be it the recording itself.
    const std::string before = text_of(file);
    Command itself({"export", file, "--perfetto", file});
    CHECK(itself.code() == 74);
    CHECK(text_of(file) == before);
    CHECK(Command({"export", file, "--perfetto", shelf / "a.json"}).code() == 74);
  }
  SECTION("export as tables") {
    Command tables({"export", file, "--csv", shelf / "tables", "--json"});
    CHECK(tables.code() == 0);
    CHECK(tables.json()["tables"].size() == 2);
    std::istringstream rows(text_of(shelf / "tables/plot.csv"));
    std::string head, row;
    std::getline(rows, head);
    std::getline(rows, row);
    CHECK(head == "time,kind,corners[0].x,corners[0].y,corners[1].x,corners[1].y\r");
    CHECK_THAT(row, Catch::EndsWith(",Wood,1,2,3,4\r"));
    Command again({"export", file, "--csv", shelf / "tables"});
    CHECK(again.code() == 74);
    CHECK_THAT(again.said(), Contains(".csv' is there already"));
  }
  SECTION("export as lines") {
    Command lines({"export", file, "--lines", shelf / "a.jsonl", "--topics", "plot"});
    CHECK(lines.code() == 0);
    std::istringstream text(text_of(shelf / "a.jsonl"));
    std::string line;
    std::getline(text, line);
    const Json first = Json::parse(line);
    CHECK(first["topic"] == "plot");
    CHECK(first["value"] == Json::parse(kPlot));
    CHECK(first["time_ns"] > 0);
    Command piped({"export", file, "--lines", "-", "--topics", "plot"});
    CHECK(piped.code() == 0);
    CHECK(piped.printed() == text_of(shelf / "a.jsonl"));
  }
  SECTION("export to nothing") {
    Command nowhere({"export", file});
    CHECK(nowhere.code() == 64);
    CHECK_THAT(nowhere.said(), Contains("--csv, --lines and --perfetto"));
  }
  SECTION("echo") {
    Command echo({"echo", "plot", "--file", file, "--count", "2", "--json"});
    CHECK(echo.code() == 0);
    CHECK(echo.json_lines() == std::vector<Json>(2, Json::parse(kPlot)));
    Command wrong({"echo", "plt", "--file", file});
    CHECK(wrong.code() == 78);
    CHECK_THAT(wrong.said(), Contains("no topic 'plt' (did you mean 'plot'?)"));
  }
  SECTION("replay") {
    Field other(vendor);
    Command text = other.start({"replay", file, "--topics", "plot", "--rate", "20"});
    CHECK(text.code() == 0);
    CHECK_THAT(text.printed(),
               Contains(" values published on domain ") && Contains(", to 1 subscriber\n"));
    CHECK(other.station().expect("heard") == "2");
    Command json = other.start({"replay", file, "--topics", "plot", "--rate", "20", "--json"});
    CHECK(json.code() == 0);
    CHECK(json.json()["topics"] == Json{"plot"});
    CHECK(json.json()["published"] > 0);
    Command wrong = other.start({"replay", file, "--topics", "plt"});
    CHECK(wrong.code() == 78);
    CHECK_THAT(wrong.said(), Contains("did you mean 'plot'?"));
  }
  SECTION("replay to commands that look") {
    Command replay({"replay", file, "--topics", "plot", "--rate", "0.02", "--domain", "80"});
    REQUIRE(replay.says("publishes plot"));
    Command echo({"echo", "plot", "--count", "1", "--json", "--domain", "80"});
    CHECK(echo.code() == 0);
    CHECK(echo.json_lines().size() == 1);
    Command topics({"topics", "--json", "--domain", "80"});
    CHECK(topics.code() == 0);
    CHECK_THAT(topics.printed(), Contains("\"plot\""));
    replay.signal(SIGINT);
    CHECK(replay.code() == 128 + SIGINT);
  }
  SECTION("replay of its decisions, of which there are none") {
    Command replay({"replay", file, "--decisions"});
    CHECK(replay.code() == 78);
    CHECK_THAT(replay.said(), Contains("has no topic 'skein/decisions'"));
  }
  SECTION("replay that is interrupted") {
    const Field other(vendor);
    Command replay = other.start({"replay", file, "--rate", "0.0001", "--json"});
    REQUIRE(replay.says("publishes plot"));
    replay.signal(SIGINT);
    CHECK(replay.code() == 128 + SIGINT);
    CHECK_THAT(replay.said(), Contains("interrupted before "));
  }
  SECTION("replay to a station that is stopped or killed") {
    Field other(vendor);
    Command replay = other.start({"replay", file, "--rate", "20"});
    REQUIRE(replay.says("publishes plot"));
    other.station().signal(GENERATE(SIGSTOP, SIGKILL));
    CHECK(replay.code() == 0);
  }
}

TEST_CASE("a recording goes on without the station that is recorded, and ends in order") {
  const std::string vendor = any_vendor();
  if (!installed(vendor)) return;
  const Shelf shelf;
  const std::string file = shelf / "flight.mcap";
  Field field(vendor);
  Command record = field.start({"record", "--output", file});
  REQUIRE(record.says("topic corner"));
  REQUIRE(eventually([&] { return Command({"info", file}).code() == 0; }));
  field.station().signal(GENERATE(SIGSTOP, SIGKILL));
  record.signal(SIGINT);
  CHECK(record.code() == 0);
  CHECK_THAT(record.printed(), Contains(file + "\n") && Contains(" messages, "));
  Command info({"info", file});
  CHECK(info.code() == 0);
  CHECK_THAT(info.printed(), !Contains("its end is missing"));
}

TEST_CASE("a recording on a full disk fails, and says what is in the file") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Shelf shelf;
  const Field field(vendor);
  const CommandOptions disk{.prepare = [] {
    constexpr rlim_t kSpace = 12'288;  // what every recording has, and a few values
    const rlimit limit{kSpace, kSpace};
    setrlimit(RLIMIT_FSIZE, &limit);
  }};
  Command text = field.start({"record", "--output", shelf / "text.mcap"}, disk);
  Command json = field.start({"record", "--output", shelf / "json.mcap", "--json"}, disk);
  CHECK(text.code() == 74);
  CHECK_THAT(text.printed(), Contains("  corner ") && Contains(" messages, "));
  CHECK_THAT(text.said(), Contains("text.mcap") && !Contains("it looked on domain"));
  CHECK(json.code() == 74);
  CHECK(json.json()["files"] == Json{shelf / "json.mcap"});
  CHECK(json.json()["messages"] > 0);
}

TEST_CASE("a recording that cannot even begin is told as output that was lost") {
  const std::string vendor = kOneVendor;
  if (!installed(vendor)) return;
  const Shelf shelf;
  const Field field(vendor);
  Command record = field.start({"record", "--output", shelf / "none.mcap"}, {.prepare = [] {
                                 const rlimit limit{4, 4};
                                 setrlimit(RLIMIT_FSIZE, &limit);
                               }});
  CHECK(record.code() == 74);  // what it says ends, as all its files, after four bytes
}

TEST_CASE("decisions that are made again are counted") {
  const Shelf shelf;
  const std::string log = shelf / "decisions.jsonl";
  std::ofstream(log).flush();
  const bool by_replay = GENERATE(true, false);
  const Words words = by_replay ? Words{"replay", log, "--decisions"}
                                : Words{"decisions", "--log", log, "--replay"};
  Command text(words);
  CHECK(text.code() == 0);
  CHECK(text.printed() == "0 decisions, 0 come out differently\n");
  CHECK_THAT(text.said(), Contains(log + " holds no decisions"));
  Words with_json = words;
  with_json.push_back("--json");
  Command json(with_json);
  CHECK(json.code() == 0);
  CHECK(json.json() == Json{{"decisions", 0}, {"different", 0}});
}

TEST_CASE("a line of a log that was cut off is told, and the whole ones are read all the same") {
  const Shelf shelf;
  const std::string log = shelf / "decisions.jsonl";
  introspection::Decision record;
  record.entity = "whole";
  record.strategy = "declared";
  record.execution = "one";
  record.failure = "nobody is there";
  const std::string line = idl::to_json(record);
  const std::string half = line.substr(0, line.size() / 2);
  const auto [text, place, whole] = GENERATE_COPY(table<std::string, std::string, int>({
      {line + '\n' + line + '\n' + half, ":3: the last line is cut off", 2},
      {line + '\n' + half + '\n' + line + '\n', ":2: the line is cut off", 2},
      {half, ":1: the last line is cut off", 0},
  }));
  std::ofstream(log) << text;
  Command read({"decisions", "--log", log, "--json"});
  CHECK(read.code() == 0);
  CHECK(read.json_lines().size() == static_cast<std::size_t>(whole));
  CHECK_THAT(read.said(), Contains(log + place));
  Command again({"decisions", "--log", log, "--replay", "--json"});
  CHECK(again.code() == 0);
  CHECK(again.json() == Json{{"decisions", whole}, {"different", 0}});
  CHECK_THAT(again.said(), Contains(log + place));
}

TEST_CASE("a feature that never helps is told beside the decisions of a log") {
  const Shelf shelf;
  const std::string log = shelf / "decisions.jsonl";
  introspection::Decision record;
  record.entity = "default/drone";
  record.service = "survey/IPlanner";
  record.features = {{"height_m", 120}};
  const std::string line = idl::to_json(record);
  std::ofstream file(log);
  for (int i = 0; i < 20; ++i) file << line << '\n';
  file.close();
  Command read({"decisions", "--log", log, "--json"});
  CHECK(read.code() == 0);
  CHECK(read.json_lines().size() == 20);
  CHECK_THAT(read.said(), Contains("the feature 'height_m' is 120 in all 20 decisions"));
}

TEST_CASE("what is no log of decisions is refused, and why it cannot be read") {
  const Shelf shelf;
  std::ofstream(shelf / "mission.xml") << "<mission name=\"m\"/>\n";
  const auto [name, why] = GENERATE(table<std::string, std::string>({
      {"nowhere.jsonl", "nowhere.jsonl' cannot be read: No such file or directory"},
      {"", "cannot be read: Is a directory"},
      {"mission.xml", "mission.xml:1: no log of decisions: "},
  }));
  Command read({"decisions", "--log", shelf / name});
  CHECK(read.code() == 78);
  CHECK_THAT(read.said(), Contains(why));
}

TEST_CASE("a recording that is not there is named") {
  const std::string command = GENERATE("info", "export", "replay");
  CAPTURE(command);
  Words words{command, "nowhere.mcap"};
  if (command == "export") words.insert(words.end(), {"--perfetto", "trace"});
  Command run(words);
  CHECK(run.code() == 78);
  CHECK(run.printed().empty());
  CHECK_THAT(run.said(), Contains("'nowhere.mcap' cannot be opened: No such file or directory"));
}
