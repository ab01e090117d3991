#include "composer.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command/designer/request_members.hpp"
#include "core/printable.hpp"
#include "design.hpp"
#include "differences.hpp"
#include "edits.hpp"
#include "mission/xml/text_file.hpp"
#include "mission/xml/xml_text.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"

namespace skein::command::compose {
namespace {

using designer::number_of;
using designer::text_of;

constexpr const char* kTakenUp = "take up what was not saved";
/// What a page may send, and so the largest text that it may compose.
constexpr std::size_t kLongestText = 1 << 20;

std::string empty_mission(const std::filesystem::path& file, const Repository& repository) {
  const std::filesystem::path& dictionary = repository.dictionary();
  std::string name = file.stem().string();
  std::ranges::replace_if(
      name, [](char c) { return c == '"' || c == '&' || c == '<'; }, '_');
  const std::string named =
      dictionary.empty() || dictionary == file.parent_path() / "dictionary.xml"
          ? ""
          : " dictionary=\"" + reference_to(dictionary, file.parent_path()) + "\"";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<mission name=\"" + name + "\"" + named +
         ">\n</mission>\n";
}

Repository looked(Repository repository) {
  repository.look();
  return repository;
}

const char* in_words(MissionFile::Disk disk) {
  if (disk == MissionFile::Disk::Same) return "";
  return disk == MissionFile::Disk::Gone ? "gone" : "changed";
}

}  // namespace

Composer::Composer(const Options& options, Publish publish)
    : options_(options),
      publish_(std::move(publish)),
      kept_(options.mission),
      repository_(looked(Repository(options.components))),
      file_(options.mission, empty_mission(options.mission, repository_)) {
  remembered_ = kept_.read_places();
  layout_.restore(remembered_);
  if (const auto draft = kept_.read_draft()) file_.restore(draft->text, draft->base);
  refresh();
  arrange();
  this->publish();
}

std::string Composer::obey(std::string_view text) {
  const nlohmann::json request = designer::request_of(text);
  std::lock_guard lock(mutex_);
  std::string answer = carry_out(text_of(request, "do"), request);
  arrange();
  keep();
  publish();
  return answer;
}

std::string Composer::carry_out(const std::string& what, const nlohmann::json& request) {
  if (what == "undo" || what == "redo") {
    const bool undo = what == "undo";
    const auto& history = file_.history();
    const std::string label = undo ? history.undo_label() : history.redo_label();
    if (label.empty()) throw InvalidArgument("there is nothing to " + what);
    undo ? file_.history().undo() : file_.history().redo();
    refresh();
    return (undo ? "undone: " : "done again: ") + label;
  }
  if (what == "save") return save(request);
  if (what == "compare") return compare(request);
  if (what == "load") {
    file_.load();
    refresh();
    return "loaded";
  }
  if (what == "look") {
    repository_.look();
    refresh();
    return "looked";
  }
  if (what == "move") {
    layout_.move(text_of(request, "entity"), {number_of(request, "x", designer::kFarthest),
                                              number_of(request, "y", designer::kFarthest)});
    return "moved";
  }
  if (what == "arrange") {
    layout_.forget();
    remembered_.clear();
    return "arranged";
  }
  return what == "text" ? replace_text(request) : edit(request);
}

void Composer::demand_version(const nlohmann::json& request) const {
  constexpr double kMost = 1e15;
  if (number_of(request, "version", kMost) != static_cast<double>(design_.version))
    throw Unavailable("the mission was changed meanwhile; look at it, and try again");
}

std::string Composer::edit(const nlohmann::json& request) {
  demand_version(request);
  if (!source_)
    throw Unavailable("the text is no well-formed XML: mend it first, under Text, or undo");
  std::optional<designer::Place> at;
  if (request.contains("x"))
    at = {number_of(request, "x", designer::kFarthest),
          number_of(request, "y", designer::kFarthest)};
  const Edit made = edit_of(request, {*source_, design_, repository_});
  const std::string after = profile::spliced(file_.text(), made.splice);
  if (after.size() > profile::kLargestFile)
    throw InvalidArgument("the mission would be larger than 8 MiB, which nobody reads");
  const profile::XmlSource demanded(after, options_.mission.string());
  file_.history().edit(made.label, made.key, made.splice);
  refresh();
  if (at) place_new(made, *at);
  return "done: " + made.label;
}

std::string Composer::replace_text(const nlohmann::json& request) {
  demand_version(request);
  const std::string text = text_of(request, "text");
  profile::demand_utf8_text(file_.text(), options_.mission.string());  // else a page cannot show it
  if (text.size() > kLongestText) throw InvalidArgument("the text is longer than 1 MiB");
  file_.history().edit("change the text", "text", profile::difference(file_.text(), text));
  refresh();
  return "changed";
}

std::string Composer::save(const nlohmann::json& request) {
  file_.save(request.value("over", false));
  return "saved as " + options_.mission.string();
}

std::string Composer::compare(const nlohmann::json& request) {
  if (designer::member(request, "with").is_null()) {
    compared_.clear();
    return "compared with nothing";
  }
  const std::filesystem::path file =
      whole_path(options_.mission.parent_path() / text_of(request, "with"));
  const auto holds = [&](const std::filesystem::path& folder) {
    const auto way = file.lexically_relative(whole_path(folder));
    return !way.empty() && *way.begin() != "..";
  };
  if (!std::ranges::any_of(options_.components, holds))
    throw InvalidArgument(file.string() + " is in none of the folders that this page may read");
  profile::FindingList findings;
  (void)profile::parse_xml(profile::read_text_file(file), file.string(), findings);
  compared_ = file;
  return "compared with " + file.string();
}

/// Of what cannot be read any more, there are none.
void Composer::find_differences() try {
  design_.compared = compared_.string();
  design_.differences.clear();
  if (compared_.empty() || !source_ || whole_path(compared_) != compared_) return;
  profile::FindingList findings;
  const auto before =
      profile::parse_xml(profile::read_text_file(compared_), compared_.string(), findings);
  const auto now = profile::parse_xml(file_.text(), options_.mission.string(), findings);
  for (const Difference& each : differences(before, now)) {
    const char* const kind = each.kind == Difference::Kind::New    ? "new"
                             : each.kind == Difference::Kind::Gone ? "gone"
                                                                   : "changed";
    design_.differences.push_back({kind, each.entity, each.whole, each.text});
  }
} catch (const profile::DescriptionError&) {
}

/// Where the user has dropped it.
void Composer::place_new(const Edit& edit, designer::Place at) {
  if (!source_) return;
  const std::size_t end = edit.splice.at + edit.splice.inserted.size();
  for (const PartState& part : design_.parts) {
    if (part.element == kNoElement || !part.csp.empty()) continue;
    const auto& element = source_->elements()[part.element];
    if (element.begin < edit.splice.at || element.end > end) continue;
    layout_.place(part.entity, at);
  }
}

/// Makes what follows from the text anew. While it is no XML, boxes stay.
void Composer::refresh() {
  if (design_.text != file_.text()) {
    checked_.reset();
    if (design_.flight.starts_with(kUnwatched)) design_.flight.clear();
  }
  DesignState design = design_of(file_.text(), options_.mission, options_.variables, repository_,
                                 checked_ ? &*checked_ : nullptr);
  if (design.elements.empty()) {
    design.parts = std::move(design_.parts);
    design.entities = std::move(design_.entities);
    design.links = std::move(design_.links);
    for (PartState& part : design.parts) part.element = kNoElement;
    source_.reset();
  } else {
    source_.emplace(file_.text(), options_.mission.string());
  }
  design.flight = design_.flight;
  design.version = design_.version + (design_.text == file_.text() ? 0 : 1);
  design.text = file_.text();
  std::swap(design_, design);
  keep_names(design);
}

/// A box that has another name since then stays where it is.
void Composer::keep_names(const DesignState& before) {
  if (before.parts.size() != design_.parts.size()) return;
  for (std::size_t i = 0; i < before.parts.size(); ++i) {
    const PartState& old = before.parts[i];
    const PartState& now = design_.parts[i];
    if (old.element == now.element && old.csp.empty() && old.entity != now.entity)
      layout_.rename(old.entity, now.entity);
  }
}

/// A box that comes again stands where it stood.
void Composer::arrange() {
  for (const auto& entity : design_.entities) {
    const auto known = remembered_.find(entity.name);
    if (known != remembered_.end() && !layout_.places().contains(entity.name))
      layout_.place(entity.name, known->second);
  }
  layout_.arrange(design_.entities, design_.links);
  for (const auto& [entity, place] : layout_.places()) remembered_[entity] = place;
}

/// What a user has done outlives this process, whatever ends it.
void Composer::keep() {
  try {
    kept_.keep_places(layout_.places());
    std::optional<KeptState::Draft> draft;
    if (file_.is_changed()) draft = {file_.text(), file_.saved()};
    kept_.keep_draft(draft);
    unkept_.clear();
  } catch (const Error& error) {
    unkept_ =
        std::string("what is not saved would be lost, and where boxes stand: ") + error.what();
  }
}

std::optional<Composer::Unchecked> Composer::unchecked() const {
  std::lock_guard lock(mutex_);
  const auto file = file_.is_changed() ? kept_.draft_file() : options_.mission;
  if (checked_ || file.empty()) return std::nullopt;
  return Unchecked{design_.version, file};
}

void Composer::tell_check(std::uint64_t version, std::vector<profile::Finding> findings) {
  std::lock_guard lock(mutex_);
  if (version != design_.version) return;
  checked_ = std::move(findings);
  refresh();
  arrange();
  publish();
}

void Composer::look_at_disk() {
  std::lock_guard lock(mutex_);
  if (in_words(file_.disk()) != std::string_view(design_.disk)) publish();
}

void Composer::tell_flight(const std::string& flight) {
  std::lock_guard lock(mutex_);
  if (design_.flight == flight) return;
  design_.flight = flight;
  publish();
}

std::filesystem::path Composer::saved_file() const {
  std::lock_guard lock(mutex_);
  if (file_.is_changed()) throw Unavailable("save the mission first");
  if (file_.disk() != MissionFile::Disk::Same)
    throw Unavailable("the file is not what is shown here: load it, or save over it");
  return options_.mission;
}

Places Composer::places() const {
  std::lock_guard lock(mutex_);
  return layout_.places();
}

void Composer::publish() {
  design_.file = options_.mission.string();
  design_.changed = file_.is_changed();
  design_.checked = checked_.has_value();
  design_.disk = in_words(file_.disk());
  design_.undo = file_.history().undo_label();
  design_.redo = file_.history().redo_label();
  design_.troubles.clear();
  for (const std::string& trouble : repository_.troubles()) design_.troubles.push_back(trouble);
  const bool taken_up = file_.history().undo_label() == kTakenUp;
  for (const std::string& trouble :
       {layout_.failure(), unkept_,
        std::string(taken_up ? "what was not saved last time is here again; Undo takes the file"
                             : "")})
    if (!trouble.empty()) design_.troubles.push_back(trouble);
  find_differences();
  state_ = std::make_shared<const std::string>(idl::to_json(design_));
  publish_(state_);
}

Composer::Json Composer::state() const {
  std::lock_guard lock(mutex_);
  return state_;
}

}  // namespace skein::command::compose
