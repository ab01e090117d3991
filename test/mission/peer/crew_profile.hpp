#pragma once

#include <filesystem>
#include <string>

#include "test/tools/places.hpp"
#include "test/tools/temporary_folder.hpp"

namespace skein::test {

/// A mission of the crew (see crew_components.cpp): an office with two CSPs, of which `moody`
/// declares the better quality and has a parameter that may change, and the peer `mission` that
/// runs it. Its folder goes with this object.
class CrewProfile {
 public:
  /// `office` and `moody` are attributes of that peer and of that CSP, `mission` a component,
  /// `visitor` a further peer, if any.
  CrewProfile(const std::string& vendor, const std::string& office, const std::string& moody,
              const std::string& mission, const std::string& visitor = "") {
    folder_.write("visitor.xml", "<component name='visitor'/>");
    folder_.write("moody.xml", csp_text("moody", "50", "0.9"));
    folder_.write("sound.xml", csp_text("sound", "10", "0.5"));
    folder_.write(
        "office.xml",
        "<component name='office'><interfaces><implements><type>IDL:crew/Desk</type>"
        "</implements></interfaces><subcomponents><subcomponent>IDL:crew/Worker</subcomponent>"
        "</subcomponents></component>");
    folder_.write(
        mission + ".xml",
        "<component name='" + mission +
            "'><dependencies><depends>IDL:crew/Desk</depends></dependencies></component>");
    folder_.write(
        "mission.xml",
        "<mission name='moods' domain='47' system='uav-1' dictionary='" +
            project_file("mission_profiles/dictionary.xml") +
            "' plugin='skein_crew_components' vendor='" + vendor +
            "'><peer name='office' component='office.xml' " + office +
            "><csp component='sound.xml' process='in'/>"
            "<csp component='moody.xml' " +
            moody +
            "><parameter name='Seed' value='1'/></csp></peer><peer name='client' component='" +
            mission + ".xml' role='mission'/>" + visitor + "</mission>");
  }

  std::filesystem::path file(const std::string& name = "mission.xml") const {
    return folder_.path() / name;
  }

 private:
  static std::string csp_text(const std::string& name, const std::string& latency_ms,
                              const std::string& quality) {
    return "<component name='" + name +
           "'><interfaces><implements><type>IDL:crew/Worker</type>"
           "<attribute name='latency' value='" +
           latency_ms + " ms'/><attribute name='quality' value='" + quality +
           "'/><optional><parameter name='Seed'/></optional></implements></interfaces></component>";
  }

  TemporaryFolder folder_;
};

}  // namespace skein::test
