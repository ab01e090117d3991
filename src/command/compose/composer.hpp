#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "command/designer/layout.hpp"
#include "design_state.idl.hpp"
#include "kept_state.hpp"
#include "mission/profile/mission_profile.hpp"
#include "mission/xml/xml_source.hpp"
#include "mission_file.hpp"
#include "repository.hpp"

namespace skein::command::compose {

struct Edit;

/// How DesignState::flight begins if a mission cannot be watched.
inline constexpr const char* kUnwatched = "cannot be watched: ";

/// A mission while it is composed: its text, and what the page shows of it. Thread-safe.
class Composer {
 public:
  using Json = std::shared_ptr<const std::string>;
  /// Takes each new DesignState, as JSON. Is called with a lock held.
  using Publish = std::function<void(Json)>;

  struct Options {
    std::filesystem::path mission;                  ///< Whole; need not be there.
    std::vector<std::filesystem::path> components;  ///< Folders with descriptions.
    profile::VariableValues variables{};
  };

  /// Throws DescriptionError for a file that cannot be read.
  Composer(const Options& options, Publish publish);

  /// Carries out a request of the page, a JSON object with `do`: what edit_of() knows, or
  /// `text` with the whole `text`, with the `version` of the text for which it is meant; `undo`,
  /// `redo`; `save`, which with `over` overwrites what others have written; `load`; `look` for
  /// components; `compare` `with` a file of these folders, the mission's own included, or with null
  /// nothing; `move` and `arrange` as designer::obey(). Returns what was done, in words. Throws as
  /// edit_of(), and Unavailable where others were faster.
  std::string obey(std::string_view request);

  /// A text that `skein check` was not asked of yet, and a file that has it.
  struct Unchecked {
    std::uint64_t version;
    std::filesystem::path file;
  };
  std::optional<Unchecked> unchecked() const;
  /// What `skein check` finds in that version.
  void tell_check(std::uint64_t version, std::vector<profile::Finding> findings);

  /// Looks whether others have changed the file.
  void look_at_disk();
  /// What became of the mission that was launched, as DesignState has it.
  void tell_flight(const std::string& flight);
  /// The file, if it has what is shown: throws Unavailable otherwise.
  std::filesystem::path saved_file() const;

  const std::filesystem::path& mission() const noexcept { return options_.mission; }
  Places places() const;
  Json state() const;

 private:
  std::string carry_out(const std::string& what, const nlohmann::json& request);
  void demand_version(const nlohmann::json& request) const;
  std::string edit(const nlohmann::json& request);
  std::string replace_text(const nlohmann::json& request);
  std::string save(const nlohmann::json& request);
  std::string compare(const nlohmann::json& request);
  void find_differences();
  void place_new(const Edit& edit, designer::Place at);
  void arrange();
  void refresh();
  void keep_names(const DesignState& before);
  void keep();
  void publish();

  const Options options_;
  const Publish publish_;
  mutable std::mutex mutex_;
  KeptState kept_;
  Repository repository_;
  MissionFile file_;
  std::optional<profile::XmlSource> source_;  // none while the text is no XML
  DesignState design_;
  std::optional<std::vector<profile::Finding>> checked_;  // of this text
  designer::Layout layout_;
  Places remembered_;               // also of boxes that have gone, which undo brings back
  std::filesystem::path compared_;  // empty: nothing
  std::string unkept_;              // why it is not
  Json state_;
};

}  // namespace skein::command::compose
