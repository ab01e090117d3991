#include "composer.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command/designer/request_members.hpp"
#include "core/printable.hpp"
#include "design.hpp"
#include "edits.hpp"
#include "mission/xml/text_file.hpp"
#include "mission/xml/xml_text.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"

namespace skein::command::compose {
namespace {

using designer::count_of;
using designer::number_of;
using designer::text_of;

/// The largest text in a request.
constexpr std::size_t kLongestText = 1 << 20;

std::string empty_mission(const std::filesystem::path& file, const Repository& repository) {
  const auto with = [&](const std::string& text, const char* name, const std::string& value) {
    const profile::XmlSource source(text, file.string());
    return profile::spliced(text, source.with_attribute(0, name, value));
  };
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<mission>\n</mission>\n";
  text = with(text, "name", printable(file.stem().string()));
  const std::filesystem::path& dictionary = repository.dictionary();
  if (dictionary.empty() || dictionary == file.parent_path() / "dictionary.xml") return text;
  return with(text, "dictionary", reference_to(dictionary, file.parent_path()));
}

Repository looked(Repository repository) {
  repository.look();
  return repository;
}

const char* in_words(MissionFile::Disk disk) {
  if (disk == MissionFile::Disk::Same) return "";
  return disk == MissionFile::Disk::Gone ? "gone" : "changed";
}

bool is_accepted(const Composer::Check& check) {
  return check.failure.empty() && std::ranges::none_of(check.findings, [](const auto& finding) {
           return finding.severity == profile::Severity::Error;
         });
}

designer::Place place_in(const nlohmann::json& request) {
  return {number_of(request, "x", designer::kFarthest),
          number_of(request, "y", designer::kFarthest)};
}

/// The entity of the element that the splice has inserted; empty: none.
std::string entity_in(const profile::Splice& splice, const DesignState& design,
                      const profile::XmlSource& source) {
  const std::size_t end = splice.at + splice.inserted.size();
  for (const PartState& part : design.parts) {
    if (part.element == kNoElement || !part.csp.empty()) continue;
    const auto& element = source.elements()[part.element];
    if (element.begin >= splice.at && element.end <= end) return part.entity;
  }
  return "";
}

}  // namespace

Composer::Composer(const Options& options, Publish publish)
    : options_(options),
      publish_(std::move(publish)),
      kept_(options.mission),
      repository_(looked(Repository(options.components))),
      file_(options.mission, empty_mission(options.mission, repository_)),
      placement_(kept_.read_places()),
      comparison_(options.components) {
  if (const auto draft = kept_.read_draft()) file_.restore(draft->text, draft->base);
  refresh();
  placement_.arrange(design_);
  this->publish();
}

std::string Composer::obey(std::string_view text) {
  const nlohmann::json request = designer::request_of(text);
  std::lock_guard lock(mutex_);
  std::string answer = carry_out(text_of(request, "do"), request);
  placement_.arrange(design_);
  keep();
  publish();
  return answer;
}

std::string Composer::carry_out(const std::string& action, const nlohmann::json& request) {
  if (action == "undo" || action == "redo") {
    const std::string label = action == "undo" ? file_.history().undo() : file_.history().redo();
    if (label.empty()) throw InvalidArgument("there is nothing to " + action);
    refresh();
    return (action == "undo" ? "undone: " : "done again: ") + label;
  }
  if (action == "save") {
    file_.save(request.value("over", false));
    return "saved as " + options_.mission.string() +
           (design_.flight == "flies" ? ", for the next launch" : "");
  }
  if (action == "compare") {
    const bool ends = designer::member(request, "with").is_null();
    comparison_.compare_with(ends ? "" : options_.mission.parent_path() / text_of(request, "with"));
    return ends ? "the comparison is ended" : "compared with " + text_of(request, "with");
  }
  if (action == "load") {
    file_.load();
    refresh();
    return "loaded";
  }
  if (action == "look") {
    repository_.look();
    check_.reset();
    refresh();
    return "looked";
  }
  if (action == "move") {
    placement_.move(text_of(request, "entity"), place_in(request));
    return "moved";
  }
  if (action == "arrange") {
    placement_.forget();
    return "arranged";
  }
  return action == "text" ? replace_text(request) : edit(request);
}

/// With the number that the request's element has by now.
nlohmann::json Composer::in_present_numbers(const nlohmann::json& request) const {
  if (!request.contains("element")) return request;
  const std::uint64_t version = count_of(request, "version");
  if (version == design_.version) return request;
  const auto element = trail_.find(count_of(request, "element"), version, *source_);
  if (!element)
    throw Unavailable("the element is gone, or another one: the mission was changed meanwhile");
  nlohmann::json present = request;
  present["element"] = *element;
  return present;
}

std::string Composer::edit(const nlohmann::json& request) {
  if (!source_)
    throw Unavailable("the text is no well-formed XML: mend it first, under Text, or undo");
  std::optional<designer::Place> at;
  if (request.contains("x")) at = place_in(request);
  const Edit made = edit_of(in_present_numbers(request), {*source_, design_, repository_});
  const std::string after = profile::spliced(file_.text(), made.splice);
  if (after.size() > profile::kLargestFile)
    throw InvalidArgument("the mission would be larger than 8 MiB, which nobody reads");
  const profile::XmlSource demanded(after, options_.mission.string());
  file_.history().edit(made.label, made.key, made.splice);
  refresh(ElementTrail::Kind::Edit);
  const std::string added = at && source_ ? entity_in(made.splice, design_, *source_) : "";
  if (!added.empty()) placement_.place(added, *at);
  return "done: " + made.label;
}

std::string Composer::replace_text(const nlohmann::json& request) {
  if (count_of(request, "version") != design_.version)
    throw Unavailable("the mission was changed meanwhile; look at it, and try again");
  const std::string text = text_of(request, "text");
  profile::demand_utf8_text(file_.text(), options_.mission.string());  // else a page cannot show it
  if (text.size() > kLongestText) throw InvalidArgument("the text is longer than 1 MiB");
  file_.history().edit("change the text", "text", profile::typed_difference(file_.text(), text));
  refresh();
  return "changed";
}

/// Derives the design from the text. While the text is no XML, boxes stay.
void Composer::refresh(ElementTrail::Kind change) {
  if (design_.text != file_.text()) {
    check_.reset();
    trail_.add(design_.version, source_ ? &*source_ : nullptr, file_.history().last_change(),
               change);
  }
  const bool is_checked = check_ && check_->failure.empty();
  DesignState design = design_of(file_.text(), options_.mission, options_.variables, repository_,
                                 is_checked ? &check_->findings : nullptr);
  if (design.elements.empty()) {
    design.parts = std::move(design_.parts);
    design.entities = std::move(design_.entities);
    design.links = std::move(design_.links);
    for (PartState& part : design.parts) part.element = kNoElement;
    source_.reset();
  } else {
    source_.emplace(file_.text(), options_.mission.string());
  }
  design.file = options_.mission.string();
  design.flight = design_.flight;
  design.version = design_.version + (design_.text == file_.text() ? 0 : 1);
  design.text = file_.text();
  placement_.follow_names(design_, design);
  design_ = std::move(design);
}

/// Unsaved work outlives this process, however it ends.
void Composer::keep() {
  try {
    kept_.keep_places(placement_.places());
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
  if (check_ && is_accepted(*check_)) return std::nullopt;
  if (!file_.is_changed() && file_.disk() == MissionFile::Disk::Same)
    return Unchecked{design_.version, options_.mission};
  const auto draft = kept_.file_with(file_.text());
  return draft.empty() ? std::nullopt : std::optional(Unchecked{design_.version, draft});
}

void Composer::tell_check(std::uint64_t version, Check check) {
  std::lock_guard lock(mutex_);
  if (version != design_.version || (check_ && check == *check_)) return;
  check_ = std::move(check);
  refresh();
  placement_.arrange(design_);
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

void Composer::demand_saved() const {
  std::lock_guard lock(mutex_);
  if (file_.is_changed()) throw Unavailable("save the mission first");
  if (file_.disk() != MissionFile::Disk::Same)
    throw Unavailable("the file has another text than the page: load it, or save over it");
}

Placement::Places Composer::places() const {
  std::lock_guard lock(mutex_);
  return placement_.places();
}

std::vector<std::filesystem::path> Composer::idl_folders() const {
  std::lock_guard lock(mutex_);
  return repository_.idl_folders();
}

void Composer::publish() {
  design_.changed = file_.is_changed();
  design_.checked = check_ && check_->failure.empty();
  design_.disk = in_words(file_.disk());
  design_.undo = file_.history().undo_label();
  design_.redo = file_.history().redo_label();
  design_.troubles.clear();
  for (const std::string& trouble : repository_.troubles()) design_.troubles.push_back(trouble);
  for (const std::string& trouble : {placement_.failure(), unkept_, check_ ? check_->failure : ""})
    if (!trouble.empty()) design_.troubles.push_back(trouble);
  if (design_.undo == MissionFile::kRestored) {
    design_.troubles.emplace_back(
        "unsaved changes of the last time are here again; Undo goes back to the file");
  }
  comparison_.tell(design_);
  publish_(std::make_shared<const std::string>(idl::to_json(design_)));
}

}  // namespace skein::command::compose
