#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "../tools/places.hpp"

namespace skein::test {

/// A mission of the crew (see crew_components.cpp): an office with two CSPs, of which `moody`
/// declares the better quality and has a parameter that may change, and the peer `mission` that
/// runs it. Its folder goes with this object.
class CrewProfile {
 public:
  /// `office` and `moody` are attributes of that peer and of that CSP, `mission` a component.
  CrewProfile(const std::string& vendor, const std::string& office, const std::string& moody,
              const std::string& mission) {
    std::string pattern = (std::filesystem::temp_directory_path() / "skein-crew-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no folder for a profile");
    folder_ = pattern;
    write("moody.xml", csp_text("moody", "50", "0.9"));
    write("sound.xml", csp_text("sound", "10", "0.5"));
    write("office.xml",
          "<component name='office'><interfaces><implements><type>IDL:crew/Desk</type>"
          "</implements></interfaces><subcomponents><subcomponent>IDL:crew/Worker</subcomponent>"
          "</subcomponents></component>");
    write(mission + ".xml",
          "<component name='" + mission +
              "'><dependencies><depends>IDL:crew/Desk</depends></dependencies></component>");
    write("mission.xml",
          "<mission name='moods' domain='47' system='uav-1' dictionary='" +
              project_file("mission_profiles/dictionary.xml") +
              "' plugin='skein_crew_components' vendor='" + vendor +
              "'><peer name='office' component='office.xml' " + office +
              "><csp component='sound.xml' process='in'/>"
              "<csp component='moody.xml' " +
              moody +
              "><parameter name='Seed' value='1'/></csp></peer><peer name='client' component='" +
              mission + ".xml' role='mission'/></mission>");
  }
  ~CrewProfile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  CrewProfile(const CrewProfile&) = delete;
  CrewProfile& operator=(const CrewProfile&) = delete;

  std::filesystem::path file() const { return folder_ / "mission.xml"; }

 private:
  static std::string csp_text(const std::string& name, const std::string& latency_ms,
                              const std::string& quality) {
    return "<component name='" + name +
           "'><interfaces><implements><type>IDL:crew/Worker</type>"
           "<attribute name='latency' value='" +
           latency_ms + " ms'/><attribute name='quality' value='" + quality +
           "'/><optional><parameter name='Seed'/></optional></implements></interfaces></component>";
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }

  std::filesystem::path folder_;
};

}  // namespace skein::test
