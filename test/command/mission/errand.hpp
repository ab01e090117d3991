#pragma once

#include <filesystem>
#include <string>

#include "test/tools/places.hpp"
#include "test/tools/temporary_folder.hpp"

namespace skein::test {

/// A folder with the small mission's components, for profiles around them; it goes with this
/// object. `office` answers, `sick` would but fails its self-test, `bad` and the CSP `bad_clerk`
/// are not made: their argument says what their factory returns or throws. `client` asks and ends,
/// `vexer` makes the office spin first, `clumsy` ends by an exception and `thrower` by what is
/// none, `herald` calls out until it is told to end, `page` does so three times, `thinker` never
/// comes to an end with a new value of its parameter Rate. `lost` and `idle` are activities that
/// are not made: by an exception, and by nothing.
class Errand {
 public:
  Errand() {
    for (const std::string desk : {"office", "sick", "bad", "bad_clerk"}) {
      write(desk + ".xml", "<component name='" + desk +
                               "'><interfaces><implements>IDL:crew/Desk</implements>"
                               "</interfaces></component>");
    }
    for (const std::string asker : {"client", "vexer"}) {
      write(asker + ".xml", "<component name='" + asker +
                                "'><dependencies><depends>IDL:crew/Desk</depends>"
                                "</dependencies></component>");
    }
    for (const std::string lone :
         {"clumsy", "herald", "idle", "lost", "page", "thinker", "thrower"})
      write(lone + ".xml", "<component name='" + lone + "'/>");
  }

  const std::filesystem::path& path() const noexcept { return folder_.path(); }

  /// A file beside the profile; its path.
  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text).string();
  }

  /// A profile with these attributes of <mission> and these peers.
  std::string profile(const std::string& attributes, const std::string& peers) const {
    return write("errand.xml", "<mission name='errand' domain='48' system='uav-1' dictionary='" +
                                   project_file("mission_profiles/dictionary.xml") +
                                   "' plugin='skein_errand_components' " + attributes + ">" +
                                   peers + "</mission>");
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace skein::test
