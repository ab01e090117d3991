#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "comparison.hpp"
#include "design_state.idl.hpp"
#include "element_trail.hpp"
#include "kept_state.hpp"
#include "mission/profile/mission_profile.hpp"
#include "mission/xml/xml_source.hpp"
#include "mission_file.hpp"
#include "placement.hpp"
#include "repository.hpp"

namespace skein::command::compose {

/// A mission while it is composed: its text, and the DesignState that the page shows. Thread-safe.
class Composer {
 public:
  /// Takes each new DesignState, as JSON. Is called with a lock held.
  using Publish = std::function<void(std::shared_ptr<const std::string>)>;

  struct Options {
    std::filesystem::path mission;                  ///< Whole; need not be there.
    std::vector<std::filesystem::path> components;  ///< Folders with descriptions.
    profile::VariableValues variables{};
  };

  /// Publishes the first state. Throws DescriptionError for a file that cannot be read, and
  /// Unavailable if another process composes it.
  Composer(const Options& options, Publish publish);

  /// Carries out a request of the page, a JSON object. `do` is one of the edits of edit_of(), or
  /// `text` with the whole `text`; both name the `version` of the text for which they are meant. An
  /// edit of an older version means the same element in the present one.
  /// Otherwise it is `undo`, `redo`, `save` (`over` overwrites the changes of others), `load`,
  /// `look` for components, `compare` `with` a file of the folders or null, or `move` and
  /// `arrange` as in designer::obey(). Returns the effect in words. Throws as edit_of(), and
  /// Unavailable if others were faster.
  std::string obey(std::string_view request);

  /// A text that `skein check` has not accepted yet, and a file with that text.
  struct Unchecked {
    std::uint64_t version;
    std::filesystem::path file;
  };
  std::optional<Unchecked> unchecked() const;

  /// The findings of `skein check`, or the reason why there are none.
  struct Check {
    std::vector<profile::Finding> findings;
    std::string failure{};
    bool operator==(const Check&) const = default;
  };
  /// Nothing happens if the text has another version by now.
  void tell_check(std::uint64_t version, Check check);

  /// Looks whether others have changed the file.
  void look_at_disk();
  /// The state of the launched mission, as in DesignState.
  void tell_flight(const std::string& flight);
  /// Throws Unavailable unless the file has the text that is shown.
  void demand_saved() const;

  Placement::Places places() const;
  std::vector<std::filesystem::path> idl_folders() const;

 private:
  std::string carry_out(const std::string& action, const nlohmann::json& request);
  nlohmann::json in_present_numbers(const nlohmann::json& request) const;
  std::string edit(const nlohmann::json& request);
  std::string replace_text(const nlohmann::json& request);
  void refresh(ElementTrail::Kind change = ElementTrail::Kind::Other);
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
  ElementTrail trail_;
  std::optional<Check> check_;  // of this text
  Placement placement_;
  Comparison comparison_;
  std::string unkept_;  // the reason if the state is not kept
};

}  // namespace skein::command::compose
