#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "installed.hpp"
#include "mission_run.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

std::string csp_text(const std::string& name, const std::string& latency_ms,
                     const std::string& quality) {
  return "<component name='" + name +
         "'><interfaces><implements><type>IDL:crew/Worker</type>"
         "<attribute name='latency' value='" +
         latency_ms + "'/><attribute name='quality' value='" + quality +
         "'/></implements></interfaces></component>";
}

/// A profile with its components, in a folder that goes with this object.
class Profile {
 public:
  Profile(const std::string& owner_vendor, const std::string& csp_vendor,
          const std::string& restart) {
    std::filesystem::create_directories(folder_);
    write("moody.xml", csp_text("moody", "50", "0.9"));
    write("sound.xml", csp_text("sound", "10", "0.5"));
    write("office.xml",
          "<component name='office'><interfaces><implements><type>IDL:crew/Desk</type>"
          "</implements></interfaces><subcomponents><subcomponent>IDL:crew/Worker</subcomponent>"
          "</subcomponents></component>");
    write("client.xml",
          "<component name='client'><dependencies><depends>IDL:crew/Desk</depends>"
          "</dependencies></component>");
    write("mission.xml", "<mission name='moods' domain='47' system='uav-1' dictionary='" DICTIONARY
                         "' plugin='skein_crew_components'>"
                         "<peer name='office' component='office.xml' vendor='" +
                             owner_vendor +
                             "'><csp component='sound.xml' process='in'/>"
                             "<csp component='moody.xml' process='own' restart='" +
                             restart + "' required='false' vendor='" + csp_vendor +
                             "'/></peer>"
                             "<peer name='client' component='client.xml' role='mission' vendor='" +
                             owner_vendor + "'/></mission>");
  }
  ~Profile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  std::filesystem::path file() const { return folder_ / "mission.xml"; }

 private:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  const std::filesystem::path folder_ = std::filesystem::current_path() / "hung_csp_profile";
};

}  // namespace

TEST_CASE(
    "a CSP that hangs, or was stopped, is killed by its owner's peer, brought back by the "
    "launcher, and works again") {
  const std::string owner = GENERATE("fastdds", "cyclonedds");
  const std::string csp = GENERATE("fastdds", "cyclonedds");
  if (!installed(owner) || !installed(csp)) return;
  CAPTURE(owner, csp);
  const Profile profile(owner, csp, "on-failure");
  const MissionRun run(profile.file());
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  for (const std::string trouble : {"hang", "stop", "stop beyond its lease"}) {
    CHECK_THAT(run.output(), Contains("sound did " + trouble));
    CHECK_THAT(run.output(), Contains("after " + trouble + " moody works again"));
  }
  CHECK_THAT(run.output(), Contains("hangs and was killed, for the launcher to start it again"));
  CHECK_THAT(run.output(), Contains("is stopped, was not heard of for its lease and was killed"));
  CHECK_THAT(run.output(), Contains("office/moody: ended by signal 9"));
}

TEST_CASE("a CSP that nobody would start again is left alone") {
  const std::string vendor = GENERATE("fastdds", "cyclonedds");
  if (!installed(vendor)) return;
  const Profile profile(vendor, vendor, "never");
  const MissionRun run(profile.file());
  INFO(run.output());
  CHECK(run.exit_code() == 2);
  CHECK_THAT(run.output(), Contains("sound did hang"));
  CHECK_THAT(run.output(), !Contains("was killed"));
}
