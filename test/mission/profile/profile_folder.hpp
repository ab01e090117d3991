#pragma once

#include <string>
#include <vector>

#include "mission/check/profile_check.hpp"
#include "test/tools/temporary_folder.hpp"

/// A folder with a small dictionary and components to compose missions from: N depends on IF and
/// has the subcomponent IP; F implements IF; P is a CSP with IP; G is a client of N.
class ProfileFolder {
 public:
  ProfileFolder() {
    write("dictionary.xml", R"(<dictionary>
  <attribute name="latency" type="duration" unit="ms" min="0" max="1000">d</attribute>
  <attribute name="isolated" type="boolean">d</attribute>
  <parameter name="Planner" type="service" interface="M/IP">d</parameter>
  <parameter name="Time limit" type="duration" unit="ms" min="1">d</parameter>
</dictionary>)");
    write("n.xml", R"(<component name="N">
  <interfaces><implements><type>M/IN</type>
    <optional><parameter name="Planner"/><parameter name="Time limit"/></optional>
  </implements></interfaces>
  <dependencies><depends>M/IF</depends></dependencies>
  <subcomponents><subcomponent>M/IP</subcomponent></subcomponents>
</component>)");
    write(
        "f.xml",
        R"(<component name="F"><interfaces><implements>M/IF</implements></interfaces></component>)");
    write(
        "p.xml",
        R"(<component name="P"><interfaces><implements>M/IP</implements></interfaces></component>)");
    write(
        "g.xml",
        R"(<component name="G"><dependencies><depends>M/IN</depends></dependencies></component>)");
  }

  void write(const std::string& name, const std::string& text) { folder_.write(name, text); }

  /// The mission around these peers, in the file m.xml; its first peer is in line 2.
  std::filesystem::path mission(const std::string& peers) {
    return folder_.write("m.xml", "<mission name=\"m\">\n" + peers + "\n</mission>");
  }

  /// The findings of a mission, one a line, without the folder's name.
  std::string check(const std::string& peers) {
    return without_folder(skein::profile::to_text(skein::profile::check_file(mission(peers))));
  }

  std::string without_folder(std::string text) const {
    const std::string prefix = folder_.path().string() + "/";
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
      text.erase(at, prefix.size());
    }
    return text;
  }

  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};
