// How the doctor reads this machine.
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "command/doctor/reading.hpp"
#include "core/system/file_descriptor.hpp"
#include "mission/supervise/mission_claim.hpp"

using namespace skein;
using namespace skein::command::doctor;

TEST_CASE("the kernel's list of UDP sockets is read by its columns") {
  const std::string text =
      "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
      "inode ref pointer drops            \n"
      "14340: 0100007F:1CE8 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 "
      "2174065 2 00000000b6b2d9e4 17\n"
      "a line that is none\n";
  const auto sockets = parse_udp(text);
  REQUIRE(sockets.size() == 1);
  CHECK(sockets[0].port == 7400);
  CHECK(sockets[0].inode == 2174065);
  CHECK(sockets[0].dropped == 17);
  CHECK(parse_udp("").empty());
}

TEST_CASE("a library's version is what follows .so") {
  CHECK(version_of("/usr/lib/libfastrtps.so.2.9.1") == "2.9.1");
  CHECK(version_of("/usr/lib/libfastrtps.so").empty());
  CHECK(version_of("").empty());
}

TEST_CASE("a launcher is seen by its claim, with the domain of its mission") {
  profile::MissionProfile mission;
  mission.name = "survey";
  mission.domain = 48;
  const auto on_48 = [] {
    std::size_t count = 0;
    for (const Launcher& launcher : read_launchers({})) count += launcher.domain == 48 ? 1 : 0;
    return count;
  };
  CHECK(on_48() == 0);
  {
    const launch::MissionClaim claim(mission, "");
    CHECK(on_48() == 1);
  }
  CHECK(on_48() == 0);
}

TEST_CASE("of a process that is stopped it is seen that it is, and how it was started") {
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM, 0));
  struct stat status {};
  REQUIRE(fstat(socket.get(), &status) == 0);
  const pid_t child = fork();
  if (child == 0) {
    raise(SIGSTOP);
    _exit(0);
  }
  int state = 0;
  REQUIRE(waitpid(child, &state, WUNTRACED) == child);
  REQUIRE(WIFSTOPPED(state));
  const auto owners = owners_of_sockets();
  kill(child, SIGKILL);
  waitpid(child, &state, 0);
  const auto owner = owners.find(status.st_ino);  // this process is not among the owners
  REQUIRE(owner != owners.end());
  CHECK(owner->second.pid == child);
  CHECK(owner->second.stopped);
  CHECK_THAT(owner->second.command, Catch::Contains("command_line_test"));
  for (const auto& [inode, program] : owners) CHECK(program.stopped == !program.command.empty());
}

TEST_CASE("other sockets are no launchers") {
  CHECK(launch::claimed_domain("@skein-launch-1000-48-123") == 48);
  for (const char* name : {"", "@", "@skein-launch-", "@skein-launch-1000",
                           "skein-launch-1000-48-1", "@skein-launch-1000-x", "/run/x"}) {
    CAPTURE(name);
    CHECK(!launch::claimed_domain(name));
  }
}

TEST_CASE("this machine can be read") {
  const Facts facts = collect_facts();
  CHECK(!facts.interfaces.empty());
  CHECK(facts.buffer > 0);
  CHECK(facts.vendors.size() >= 2);
  for (const VendorModule& vendor : facts.vendors) {
    CAPTURE(vendor.name, vendor.library);
    CHECK(vendor.failure.empty() == !vendor.version.empty());
  }
}
