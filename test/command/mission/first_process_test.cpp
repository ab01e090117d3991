// `skein` as PID 1, as it is in a container: the first process of a PID namespace has no default
// actions for signals, and every orphan becomes its child.
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>

#include "test/tools/command_run.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

/// While it lives, the next process that this one forks is PID 1 of a new namespace.
class NewPidSpace {
 public:
  NewPidSpace() {
    if (before_ >= 0 && unshare(CLONE_NEWPID) == 0) return;
    std::fprintf(stderr, "skipped: PID namespaces may not be made here\n");
    std::_Exit(77);
  }
  NewPidSpace(const NewPidSpace&) = delete;
  NewPidSpace& operator=(const NewPidSpace&) = delete;
  ~NewPidSpace() {
    setns(before_, CLONE_NEWPID);
    close(before_);
  }

 private:
  const int before_ = open("/proc/self/ns/pid", O_RDONLY | O_CLOEXEC);
};

/// A run of `skein` whose process is PID 1, and sees its own /proc.
class FirstProcess {
 public:
  explicit FirstProcess(const std::vector<std::string>& arguments)
      : run_(arguments, {.prepare = [] {
               if (getpid() != 1 || unshare(CLONE_NEWNS) != 0 ||
                   mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
                   mount("proc", "/proc", "proc", 0, nullptr) != 0)
                 _exit(126);
             }}) {}

  CommandRun* operator->() { return &run_; }

  struct Child {
    pid_t number;  // in this test's namespace
    char state;    // `Z`: it has ended, and was not waited for
  };
  std::vector<Child> children() const {
    std::vector<Child> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::string text;
      std::getline(std::ifstream(entry.path() / "stat"), text);
      const auto end = text.rfind(") ");
      if (end == std::string::npos || std::atoi(text.c_str() + end + 4) != run_.pid()) continue;
      found.push_back({std::atoi(text.c_str()), text[end + 2]});
    }
    return found;
  }

  /// Nothing as long as PID 1 has no child that its namespace knows by `number`.
  std::optional<Child> child(const std::string& number) const {
    for (const Child& child : children()) {
      std::ifstream status("/proc/" + std::to_string(child.number) + "/status");
      for (std::string line; std::getline(status, line);) {
        if (line.starts_with("NSpid:") && line.ends_with("\t" + number)) return child;
      }
    }
    return std::nullopt;
  }

 private:
  NewPidSpace space_;
  CommandRun run_;
};

/// A mission of one farmer, whose dog becomes an orphan at once, in a session of its own and
/// without the farmer's environment. It runs until the file `away` is there.
class Farm {
 public:
  Farm() {
    folder_.write("dictionary.xml", "<dictionary/>");
    script("dog.sh", "echo $$ > dog.new; mv dog.new dog; until [ -e away ]; do sleep 0.01; done");
    script("farmer.sh",
           "trap 'echo > goodbye; exit 0' INT; (env -i setsid ./dog.sh &)\n"
           "until [ -e dog ]; do sleep 0.01; done; echo >&$SKEIN_READY_FD\n"
           "while :; do sleep 0.01; done");
    profile_ = folder_
                   .write("farm.xml",
                          "<mission name='farm' domain='49'><peer name='farmer' ready='told' "
                          "role='mission' program='./farmer.sh'/></mission>")
                   .string();
  }

  const std::string& profile() const { return profile_; }
  void dog_may_go() const { folder_.write("away", ""); }
  bool farmer_said_goodbye() const { return std::filesystem::exists(folder_.path() / "goodbye"); }

  /// The dog's number in its namespace.
  std::string dog() const {
    std::string number;
    std::getline(std::ifstream(folder_.path() / "dog"), number);
    return number;
  }

 private:
  void script(const std::string& name, const std::string& text) const {
    std::filesystem::permissions(folder_.write(name, "#!/bin/sh\ncd \"${0%/*}\"\n" + text + "\n"),
                                 std::filesystem::perms::owner_all);
  }

  TemporaryFolder folder_;
  std::string profile_;
};

}  // namespace

TEST_CASE("a launcher that is PID 1 waits for every orphan that ends, and goes on") {
  const Farm farm;
  FirstProcess launcher({"launch", "--verbose", "--no-log", farm.profile()});
  REQUIRE(launcher->writes("farmer: ready"));
  REQUIRE(eventually([&] { return launcher.child(farm.dog()).has_value(); }));
  farm.dog_may_go();
  CHECK(eventually([&] { return !launcher.child(farm.dog()); }));
  for (const auto& child : launcher.children()) CHECK(child.state != 'Z');
  launcher->signal(SIGTERM);
  CHECK(launcher->wait() == 128 + SIGTERM);
}

TEST_CASE("a signal to a launcher that is PID 1 ends the mission in order") {
  const int signal = GENERATE(SIGTERM, SIGINT, SIGHUP);
  CAPTURE(signal);
  const Farm farm;
  FirstProcess launcher({"launch", "--verbose", "--no-log", farm.profile()});
  REQUIRE(launcher->writes("farmer: ready"));
  launcher->signal(signal);
  CHECK(launcher->wait() == 128 + signal);
  CHECK(farm.farmer_said_goodbye());
}

TEST_CASE("SIGQUIT to a launcher that is PID 1 ends it at once") {
  const Farm farm;
  FirstProcess launcher({"launch", "--verbose", "--no-log", farm.profile()});
  REQUIRE(launcher->writes("farmer: ready"));
  launcher->signal(SIGQUIT);
  CHECK(launcher->wait() == 128 + SIGQUIT);
  CHECK_FALSE(farm.farmer_said_goodbye());
}

TEST_CASE("the exit code of a launcher that is PID 1 is the mission's") {
  const TemporaryFolder folder;
  folder.write("dictionary.xml", "<dictionary/>");
  const auto profile =
      folder.write("lone.xml",
                   "<mission name='lone' domain='49'><peer name='lone' role='mission' "
                   "program='/bin/sh'><argument value='-c'/><argument value='exit 7'/></peer>"
                   "</mission>");
  FirstProcess launcher({"launch", "--no-log", profile.string()});
  CHECK(launcher->wait() == 7);
}

TEST_CASE("a signal ends a command that is PID 1 and does not handle it") {
  const int signal = GENERATE(SIGTERM, SIGINT, SIGHUP, SIGQUIT);
  CAPTURE(signal);
  const TemporaryFolder folder;
  folder.write("dictionary.xml", "<dictionary/>");
  folder.write("office.xml", "<component name='office'/>");
  const auto profile = folder.write("hangs.xml",
                                    "<mission name='hangs' domain='49' "
                                    "plugin='skein_broken_components'><peer name='office' "
                                    "component='office.xml'/></mission>");
  setenv("BROKEN_PLUGIN", "hangs", 1);
  FirstProcess check({"check", profile.string()});
  unsetenv("BROKEN_PLUGIN");
  // The plugin is looked at in a process of its own.
  REQUIRE(eventually([&] { return !check.children().empty(); }));
  check->signal(signal);
  CHECK(check->wait() == 128 + signal);
}
