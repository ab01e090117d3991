// A launcher whose output nobody reads, or whose reader goes: the mission goes on.
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "core/system/file_descriptor.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein;
using namespace skein::test;
using Catch::Contains;

namespace {

/// A mission of one clerk, who says much and is restarted; its stdout is a pipe.
class Clerkship {
 public:
  /// `and_ends`: the mission ends when the file `end` is there.
  explicit Clerkship(bool and_ends = false) : pipe_((folder_.path() / "pipe").string()) {
    ::mkfifo(pipe_.c_str(), 0600);
    reader_ = FileDescriptor(::open(pipe_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    folder_.write("starts", "");
    folder_.write("dictionary.xml", "<dictionary/>");
    script("clerk.sh",
           "echo $$ >> ${0%clerk.sh}starts; echo >&$SKEIN_READY_FD\n"
           "while :; do echo much; sleep 0.01; done\n");
    script("end.sh", "echo >&$SKEIN_READY_FD; until [ -e ${0%end.sh}end ]; do sleep 0.01; done\n");
    const std::string end = R"(<peer name="end" program="./end.sh" ready="told" role="mission"/>)";
    profile_ = folder_
                   .write("city.xml",
                          R"(<mission name="city" domain="49"><peer name="clerk" ready="told"
 program="./clerk.sh" restart="on-failure"/>)" +
                              (and_ends ? end : "") + "</mission>")
                   .string();
  }

  const std::string& profile() const { return profile_; }
  const std::string& pipe() const { return pipe_; }

  void fill_pipe() const {
    const FileDescriptor writer(::open(pipe_.c_str(), O_WRONLY | O_NONBLOCK));
    const std::string text(4096, '-');
    while (::write(writer.get(), text.data(), text.size()) > 0) {
    }
  }
  void reader_goes() { reader_.reset(); }

  /// The processes that the clerk has had until now.
  std::vector<pid_t> starts() const {
    std::ifstream file(folder_.path() / "starts");
    std::vector<pid_t> numbers;
    for (std::string line; std::getline(file, line) && !file.eof();)
      numbers.push_back(std::stoi(line));
    return numbers;
  }
  bool has_started(std::size_t times) const {
    return eventually([&] { return starts().size() >= times; });
  }
  void may_end() { folder_.write("end", ""); }

 private:
  void script(const std::string& name, const std::string& text) {
    std::filesystem::permissions(folder_.write(name, "#!/bin/sh\n" + text),
                                 std::filesystem::perms::owner_all);
  }

  TemporaryFolder folder_;
  std::string pipe_;
  std::string profile_;
  FileDescriptor reader_;
};

}  // namespace

TEST_CASE("a launcher whose output nobody takes restarts, answers, and ends all the same") {
  Clerkship mission;
  mission.fill_pipe();
  CommandRun launcher({"launch", mission.profile()}, {.output = mission.pipe()});
  for (std::size_t starts = 1; starts <= 3; ++starts) {
    REQUIRE(mission.has_started(starts));
    CommandRun status({"status", mission.profile()});
    CHECK(status.wait() == 0);
    kill(mission.starts().at(starts - 1), SIGKILL);
  }
  REQUIRE(mission.has_started(4));
  launcher.signal(SIGTERM);
  CHECK(launcher.wait() == 128 + SIGTERM);
  CHECK_THAT(launcher.output(), Contains("clerk: ended by signal 9 (Killed); restart number 3"));
}

TEST_CASE("a launcher whose reader goes flies on, and says at its end that output is lost") {
  Clerkship mission(true);
  CommandRun launcher({"launch", mission.profile()}, {.output = mission.pipe()});
  REQUIRE(mission.has_started(1));
  mission.reader_goes();
  kill(mission.starts().at(0), SIGKILL);
  REQUIRE(mission.has_started(2));
  mission.may_end();
  CHECK(launcher.wait() == 74);
  CHECK_THAT(launcher.output(), Contains("the output could not be written: Broken pipe"));
}
