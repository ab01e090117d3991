// What the commands say that look at a domain: who is there, who speaks to whom, what it costs.
#include <pty.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "skein/entity.hpp"
#include "test/command/mission/errand.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/places.hpp"
#include "worker.idl.hpp"

using namespace skein;
using namespace skein::test;
using Catch::Contains;

namespace {

const std::string kOffice = "<peer name='office' component='office.xml'/>";

class Desk final : public crew::Desk {
 public:
  std::string ask(const std::string& text) override { return text; }
};

nlohmann::json of_name(const nlohmann::json& list, const std::string& name) {
  for (const auto& each : list)
    if (each["name"] == name) return each;
  return nullptr;
}

/// What the command prints, once that holds `part`.
std::string output_with(const std::vector<std::string>& words, const std::string& part) {
  std::string output;
  eventually([&] {
    CommandRun run(words);
    output = run.wait() == 0 ? run.output() : "";
    return output.find(part) != std::string::npos;
  });
  return output;
}

/// A command in a terminal of its own.
class InTerminal {
 public:
  InTerminal(std::vector<std::string> words, const std::vector<std::string>& environment) {
    const winsize size{24, 80, 0, 0};
    pid_ = forkpty(&terminal_, nullptr, nullptr, &size);
    if (pid_ < 0) throw std::runtime_error("no terminal for a command");
    if (pid_ == 0) {
      words.insert(words.begin(), built_program("skein"));
      std::vector<char*> argv;
      for (std::string& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      for (std::string variable : environment) putenv(strdup(variable.c_str()));
      execv(argv[0], argv.data());
      _exit(127);
    }
    reader_ = std::thread([this] { read_all(); });
  }
  ~InTerminal() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    if (reader_.joinable()) reader_.join();
    close(terminal_);
  }
  InTerminal(const InTerminal&) = delete;
  InTerminal& operator=(const InTerminal&) = delete;

  std::string output() const {
    std::lock_guard lock(mutex_);
    return output_;
  }
  bool writes(const std::string& part) const {
    return eventually([&] { return output().find(part) != std::string::npos; });
  }
  void type(const std::string& keys) const {
    REQUIRE(write(terminal_, keys.data(), keys.size()) == static_cast<ssize_t>(keys.size()));
  }
  void resize(unsigned short rows, unsigned short columns) const {
    const winsize size{rows, columns, 0, 0};
    REQUIRE(ioctl(terminal_, TIOCSWINSZ, &size) == 0);
  }
  /// All that it has written is in output() then.
  int wait() {
    int status = -1;
    const bool ended = eventually([&] {
      if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
      pid_ = -1;
      return true;
    });
    if (ended) reader_.join();  // its last read fails: nobody has the terminal open any more
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  void read_all() {
    char part[4096];
    for (ssize_t size; (size = read(terminal_, part, sizeof part)) > 0;) {
      std::lock_guard lock(mutex_);
      output_.append(part, static_cast<std::size_t>(size));
    }
  }

  pid_t pid_ = -1;
  int terminal_ = -1;
  mutable std::mutex mutex_;
  std::string output_;
  std::thread reader_;
};

/// The last frame, without what moves the cursor.
std::string last_frame(const std::string& output) {
  const std::size_t begin = output.rfind("\x1b[H", output.rfind("\x1b[J"));
  return begin == std::string::npos ? "" : output.substr(begin);
}

}  // namespace

TEST_CASE("a command tells of a SKEIN_LOG that is no level, though it logs nothing") {
  CommandOptions options;
  options.prepare = [] { setenv("SKEIN_LOG", "loud", 1); };
  CommandRun version({"--version"}, options);
  CHECK(version.wait() == 0);
  CHECK_THAT(version.output(), Contains("SKEIN_LOG is 'loud', which is no level"));
}

TEST_CASE("peers are listed with their processes and services, whatever their vendor") {
  const std::string vendor = GENERATE("fastdds", "cyclonedds");
  if (!installed("cyclonedds") || !installed(vendor)) return;
  Entity desk({.name = "desk", .system = "hq", .vendor = dds::load_vendor(vendor), .domain = 61});
  desk.provide<crew::Desk>(std::make_shared<Desk>());
  const auto list =
      nlohmann::json::parse(output_with({"peers", "--domain", "61", "--json"}, "\"crew/Desk\""));
  const auto peer = of_name(list, "hq/desk");
  REQUIRE(!peer.is_null());
  CHECK(peer["pid"] == getpid());
  CHECK(peer["vendor"] == vendor);
  CHECK(peer["answers"] == true);
  CHECK(peer["process"]["memory"] > 1'000'000);
  CHECK(peer["services"][0]["service"] == "crew/Desk");
  CommandRun text({"peers", "--domain", "61"});
  CHECK(text.wait() == 0);
  CHECK_THAT(text.output(), Contains("hq/desk") && Contains("provides crew/Desk") &&
                                Contains("pid " + std::to_string(getpid())));
}

TEST_CASE("a peer that is stopped holds no command up") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  const Errand errand;
  CommandRun mission({"launch", errand.profile("", kOffice)});
  REQUIRE(mission.writes("all 1 processes are ready"));
  const auto list =
      nlohmann::json::parse(output_with({"peers", "--domain", "48", "--json"}, "uav-1/office"));
  const pid_t office = of_name(list, "uav-1/office")["pid"];
  REQUIRE(kill(office, SIGSTOP) == 0);
  std::vector<std::vector<std::string>> commands{{"top", "--once"}};
  for (const std::string& command : commands_with("--wait")) commands.push_back({command});
  CHECK(commands.size() > 4);
  for (std::vector<std::string>& words : commands) {
    CAPTURE(words.front());
    words.insert(words.end(), {"--domain", "48"});
    CommandRun run(words);
    CHECK(run.wait() == 0);
  }
  kill(office, SIGCONT);
}

TEST_CASE("the graph shows who has connected to whom, in each notation") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  Entity desk(
      {.name = "desk", .system = "hq", .vendor = dds::load_vendor("fastdds"), .domain = 62});
  desk.provide<crew::Desk>(std::make_shared<Desk>());
  Entity visitor(
      {.name = "visitor", .system = "hq", .vendor = dds::load_vendor("cyclonedds"), .domain = 62});
  auto proxy = visitor.connect<crew::Desk>();
  const std::string dot = output_with({"graph", "--domain", "62"}, "->");
  CHECK_THAT(dot, Contains("label=\"hq\"") && Contains("[label=\"visitor\"]") &&
                      Contains("[label=\"desk\\ncrew/Desk\"]") && Contains("label=\"crew/Desk\\n"));
  CHECK_THAT(dot, !Contains("skein-graph"));
  CHECK_THAT(output_with({"graph", "--domain", "62", "--format", "mermaid"}, "-->"),
             Contains("flowchart LR"));
  const auto json =
      nlohmann::json::parse(output_with({"graph", "--domain", "62", "--format", "json"}, "from"));
  CHECK(json["edges"].size() == 1);
  CommandRun short_form({"graph", "--domain", "62", "--json"});
  CHECK(short_form.wait() == 0);
  CHECK(nlohmann::json::parse(short_form.output()).contains("nodes"));
  CommandRun wrong({"graph", "--format", "pdf"});
  CHECK(wrong.wait() == 64);
}

TEST_CASE("the statistics of a service tell how its clients reach it, and why not faster") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  const auto vendor = dds::load_vendor("fastdds");
  Entity desk({.name = "desk", .system = "hq", .vendor = vendor, .domain = 64});
  desk.provide<crew::Desk>(std::make_shared<Desk>());
  Entity near({.name = "near", .system = "hq", .vendor = vendor, .domain = 64});
  Entity plain({.name = "plain",
                .system = "hq",
                .vendor = vendor,
                .domain = 64,
                .shared_memory_calls = false});
  auto near_desk = near.connect<crew::Desk>();
  auto plain_desk = plain.connect<crew::Desk>();
  CHECK(near_desk.ask("one") == "one");
  const std::vector<std::string> words{"services", "--statistics", "--domain", "64"};
  CHECK_THAT(output_with(words, "from hq/plain"),
             Contains("from hq/near: shared memory, 1 calls\n") &&
                 Contains("from hq/plain: DDS, 0 calls; not faster: the caller does not use shared "
                          "memory for calls\n"));
  auto as_json = words;
  as_json.emplace_back("--json");
  const auto json = nlohmann::json::parse(output_with(as_json, "hq/plain"));
  REQUIRE(json.size() == 1);
  const auto& connections = json[0]["connections"];
  REQUIRE(connections.size() == 2);
  const auto& of_near = connections[connections[0]["client"] == "hq/near" ? 0 : 1];
  CHECK(of_near["transport"] == "shared memory");
  CHECK(of_near["not_faster"] == "");
  CHECK(of_near["calls"] == 1);
}

TEST_CASE("top prints one frame with what each process uses and how often services are called") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  Entity desk(
      {.name = "desk", .system = "hq", .vendor = dds::load_vendor("fastdds"), .domain = 63});
  desk.provide<crew::Desk>(std::make_shared<Desk>());
  Entity visitor(
      {.name = "visitor", .system = "hq", .vendor = dds::load_vendor("fastdds"), .domain = 63});
  auto proxy = visitor.connect<crew::Desk>();
  CHECK(proxy.ask("anything new") == "anything new");
  const std::string frame = output_with({"top", "--once", "--domain", "63"}, "crew/Desk");
  CHECK_THAT(frame, Contains("hq/desk") && Contains("hq/visitor") && Contains("domain 63") &&
                        Contains(std::to_string(getpid())) && !Contains("\x1b"));
  const auto json = nlohmann::json::parse(
      output_with({"top", "--once", "--domain", "63", "--json"}, "\"crew/Desk\""));
  CHECK(of_name(json["peers"], "hq/desk")["pid"] == getpid());
  CHECK(of_name(json["peers"], "hq/visitor")["state"] == "ok");
  CHECK(json["services"][0]["service"] == "crew/Desk");
  CHECK(json["services"][0]["entity"] == "hq/desk");
}

TEST_CASE("top takes the whole screen, obeys keys, and leaves the terminal as it was") {
  if (!installed("cyclonedds")) return;
  Entity desk(
      {.name = "desk", .system = "hq", .vendor = dds::load_vendor("cyclonedds"), .domain = 64});
  InTerminal top({"top", "--domain", "64", "--every", "0.2"}, {"TERM=xterm", "NO_COLOR="});
  REQUIRE(top.writes("hq/desk"));
  CHECK_THAT(top.output(), Contains("\x1b[?1049h"));
  CHECK_THAT(top.output(), Contains("PEER (by CPU)"));
  top.type("m");
  CHECK(top.writes("PEER (by memory)"));
  top.type("\t");
  CHECK(top.writes("arrows: services"));
  top.resize(10, 50);
  CHECK(eventually([&] {
    const std::string frame = last_frame(top.output());
    return std::ranges::count(frame, '\n') == 9;
  }));
  top.type("\x1b[B\x1b[1;5Dq");
  CHECK(top.wait() == 0);
  CHECK(top.output().ends_with("\x1b[?25h\x1b[?1049l"));
}

TEST_CASE("Ctrl-C ends top, and the terminal is as it was") {
  if (!installed("cyclonedds")) return;
  InTerminal top({"top", "--domain", "65", "--every", "0.2"}, {"TERM=xterm"});
  REQUIRE(top.writes("q quit"));
  top.type("\x03");
  CHECK(top.wait() == 0);
  CHECK(top.output().ends_with("\x1b[?1049l"));
}

TEST_CASE("without colour nothing is coloured, and a dumb terminal gets text alone") {
  if (!installed("cyclonedds")) return;
  {
    InTerminal top({"top", "--domain", "66", "--every", "0.2"}, {"TERM=xterm", "NO_COLOR=1"});
    REQUIRE(top.writes("q quit"));
    CHECK_THAT(top.output(), !Contains("\x1b[3"));
  }
  InTerminal dumb({"top", "--domain", "66", "--every", "0.2"}, {"TERM=dumb"});
  REQUIRE(dumb.writes("SERVICE"));
  CHECK_THAT(dumb.output(), !Contains("\x1b"));
}

namespace {

/// An entity with a service, called from the command line.
struct StaffedDesk {
  explicit StaffedDesk(unsigned domain_)
      : domain(std::to_string(domain_)),
        entity({.name = "desk",
                .system = "hq",
                .vendor = dds::load_vendor("cyclonedds"),
                .domain = domain_}) {
    entity.provide<crew::Desk>(std::make_shared<Desk>());
  }

  std::string domain;
  Entity entity;
};

struct Ended {
  int code = 0;
  std::string output;
};

Ended ended(const std::vector<std::string>& words) {
  CommandRun run(words);
  const int code = run.wait();
  return {code, run.output()};
}

}  // namespace

TEST_CASE("a service is called by its interface, its entity, or its system and entity") {
  if (!installed("cyclonedds")) return;
  const StaffedDesk desk(67);
  for (const char* name : {"Desk", "crew::Desk", "desk", "hq/desk", "crew/Desk"}) {
    CAPTURE(name);
    const Ended call = ended({"call", name, "ask", "\"hello\"", "--domain", desk.domain});
    CHECK(call.output == "\"hello\"\n");
    CHECK(call.code == 0);
  }
  const Ended described = ended({"describe", "hq/desk", "--domain", desk.domain});
  CHECK_THAT(described.output, Contains("interface Desk"));
}

TEST_CASE("a managed interface is told with the entity that it belongs to") {
  if (!installed("cyclonedds")) return;
  Entity entity(
      {.name = "desk", .system = "hq", .vendor = dds::load_vendor("cyclonedds"), .domain = 77});
  entity.provide<crew::Desk>(std::make_shared<Desk>(), {.subcomponents = {"crew/Worker"}});
  const Ended described = ended({"describe", "Worker", "--domain", "77"});
  CHECK(described.code == 69);
  CHECK_THAT(described.output, Contains("'Worker' is a managed interface of hq/desk: it is between "
                                        "that entity and its CSPs"));
}

TEST_CASE("an example of an operation's arguments is taken as it stands") {
  if (!installed("cyclonedds")) return;
  const StaffedDesk desk(68);
  const Ended example =
      ended({"call", "desk", "ask", "--example", "--json", "--domain", desk.domain});
  CHECK(example.output == "{\"task\":\"\"}\n");
  const Ended call = ended({"call", "desk", "ask", example.output, "--domain", desk.domain});
  CHECK(call.output == "\"\"\n");
  CHECK(call.code == 0);
}

TEST_CASE("who calls without arguments, or without quotes, is told what the operation needs") {
  if (!installed("cyclonedds")) return;
  const StaffedDesk desk(69);
  const Ended without = ended({"call", "desk", "ask", "--domain", desk.domain});
  CHECK(without.code == 78);
  CHECK_THAT(without.output, Contains("ask needs task (string); for text write '\"text\"', for a "
                                      "file write - < request.json"));
  const Ended unquoted = ended({"call", "desk", "ask", "synthetic:7", "--domain", desk.domain});
  CHECK(unquoted.code == 78);
  CHECK_THAT(unquoted.output,
             Contains("this is no JSON") && Contains("ask needs task (string); for text write "
                                                     "'\"synthetic:7\"'"));
  const Ended yaml = ended({"call", "desk", "ask", "{task: 'x'}", "--domain", desk.domain});
  CHECK(yaml.code == 78);
  CHECK_THAT(yaml.output, Contains("this is no JSON") && Contains("--example prints a template") &&
                              !Contains("for text write"));
}

TEST_CASE("what is not there is told with the domain, and by an exit code of its own") {
  if (!installed("cyclonedds")) return;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"call", "IGreeter", "greet", "1"},
        {"echo", "pose"},
        {"describe", "IGreeter"},
        {"rate", "pose"},
        {"publish", "pose", "1"}}) {
    CAPTURE(words.front());
    auto all = words;
    all.insert(all.end(), {"--domain", "70", "--wait", "200ms"});
    const Ended command = ended(all);
    CHECK(command.code == 69);
    CHECK_THAT(command.output, Contains("domain 70"));
  }
  for (const char* command : {"topics", "services", "peers"}) {
    CAPTURE(command);
    const Ended list = ended({command, "--domain", "70", "--wait", "200ms"});
    CHECK(list.code == 0);
    CHECK_THAT(list.output, Contains("in domain 70"));
  }
}

TEST_CASE("who is told not to wait does not") {
  if (!installed("cyclonedds")) return;
  for (const std::string& command : commands_with("--wait")) {
    CAPTURE(command);
    CHECK(ended({command, "--domain", "70", "--wait", "0"}).code == 0);
  }
  CHECK(ended({"describe", "IGreeter", "--domain", "70", "--wait", "0"}).code == 69);
}

TEST_CASE("who finds nothing is told of missions on other domains of this host") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  const Errand errand;
  CommandRun mission({"launch", errand.profile("", kOffice)});
  REQUIRE(mission.writes("all 1 processes are ready"));
  CHECK_THAT(ended({"services", "--domain", "71", "--wait", "0"}).output,
             Contains("missions fly here on domain 48"));
  CHECK_THAT(ended({"echo", "pose", "--domain", "71", "--wait", "0"}).output,
             Contains("missions fly here on domain 48"));
}

TEST_CASE("a domain of the environment is watched where no option names one") {
  if (!installed("cyclonedds")) return;
  const auto run_in = [](const char* domain, const std::vector<std::string>& words) {
    CommandRun run(words, {.prepare = [domain] { setenv("SKEIN_DOMAIN", domain, 1); }});
    const int code = run.wait();
    return Ended{code, run.output()};
  };
  const auto services = [&](std::vector<std::string> words, const char* domain) {
    words.insert(words.begin(), {"services", "--wait", "0"});
    return run_in(domain, words);
  };
  CHECK_THAT(services({}, "72").output, Contains("in domain 72"));
  CHECK_THAT(services({"--domain", "73"}, "72").output, Contains("in domain 73"));
  CHECK(services({}, "seven").code == 78);
  const Errand errand;
  CHECK_THAT(services({"--profile", errand.profile("", kOffice)}, "72").output,
             Contains("in domain 48"));
  CHECK_THAT(run_in("72", {"doctor"}).output, Contains("nobody speaks on domain 72"));
}

TEST_CASE("who watches a domain on which nothing happens is told what is waited for") {
  if (!installed("cyclonedds")) return;
  for (const std::string what : {"call", "decision"}) {
    const std::string told =
        "skein: waiting for the next " + what + " on domain 74; Ctrl-C ends it";
    InTerminal watch({what + "s", "--domain", "74"}, {});
    CHECK(watch.writes(told));
    watch.type("\x03");
    CHECK(watch.wait() == 0);
    CommandRun elsewhere({what + "s", "--domain", "74"});
    CHECK(elsewhere.writes(told));
    elsewhere.signal(SIGINT);
    CHECK(elsewhere.wait() == 0);
  }
}

TEST_CASE("who cannot join the domain is told so, and by another code than who finds nothing") {
  const std::string vendor = GENERATE("fastdds", "cyclonedds");
  if (!installed(vendor)) return;
  const auto without_interface = [] { unshare(CLONE_NEWNET); };  // its loopback is down
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"services"}, {"topics"}, {"echo", "pose"}}) {
    CAPTURE(words.front(), vendor);
    auto all = words;
    all.insert(all.end(), {"--domain", "75", "--vendor", vendor});
    CommandRun run(all, {.prepare = without_interface});
    CHECK(run.wait() == 71);
    CHECK_THAT(run.output(), Contains("no participant in domain 75"));
  }
}

TEST_CASE("whose reader has gone ends by SIGPIPE, without a word about it") {
  if (!installed("cyclonedds")) return;
  StaffedDesk desk(75);
  auto proxy = desk.entity.connect<crew::Desk>();
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  CommandRun calls({"calls", "--domain", desk.domain},
                   {.prepare = [&] { dup2(ends[1], STDOUT_FILENO), close(ends[0]); }});
  close(ends[0]);
  close(ends[1]);
  int code = -1;
  CHECK(eventually([&] {
    proxy.ask("anything");
    return (code = calls.wait(std::chrono::seconds(0))) != -1;
  }));
  CHECK(code == 128 + SIGPIPE);
  CHECK(calls.output() ==
        "skein: waiting for the next call on domain " + desk.domain + "; Ctrl-C ends it\n");
}

TEST_CASE("a recording says into which file, and which topics have not appeared") {
  if (!installed("cyclonedds")) return;
  const Ended recording = ended({"record", "--domain", "76", "--topics", "nosuch", "--for", "200ms",
                                 "--output", "flight.mcap"});
  CHECK(recording.code == 69);
  CHECK_THAT(recording.output, Contains("recording into flight.mcap what domain 76 has") &&
                                   Contains("topic 'nosuch' has not appeared") &&
                                   Contains("nothing was recorded"));
}

TEST_CASE("a file that holds nothing is no recording to rely on") {
  const Errand errand;
  const std::string file = errand.profile("", kOffice) + ".mcap";
  std::ofstream{file};
  const Ended info = ended({"info", file});
  CHECK(info.code == 1);
  CHECK_THAT(info.output, Contains("holds nothing: the file is empty"));
}
