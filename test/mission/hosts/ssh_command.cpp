#include <catch2/catch.hpp>
#include <cstdlib>

#include "mission/hosts/ssh_attendance.hpp"
#include "mission/supervise/shell_word.hpp"
#include "test/tools/shell.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein::launch;

TEST_CASE("A connection to another host is its own, whatever the user's ssh would share") {
  if (std::system("command -v ssh > /dev/null") != 0) {
    WARN("not checked: ssh is not installed");
    return;
  }
  TemporaryFolder folder;
  const std::string config =
      folder.write("config", "ControlMaster auto\nControlPath /tmp/shared\nControlPersist yes\n");
  SshAttendance attendance;
  attendance.host = "beta";
  attendance.command = "true";
  std::string command;  // -G: what would be done, by the user's configuration and these words
  for (const std::string& word : ssh_command(attendance))
    command += (command.empty() ? "" : " ") + shell_word(word) +
               (command.empty() ? " -G -F " + config : "");
  const auto [exit_code, said] = skein::test::shell(command);
  CHECK(exit_code == 0);
  CHECK_THAT(said, Catch::Contains("controlmaster false\n"));
  CHECK_THAT(said, !Catch::Contains("/tmp/shared"));
}
