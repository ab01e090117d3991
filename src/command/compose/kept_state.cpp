#include "kept_state.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <nlohmann/json.hpp>

#include "core/system/state_folder.hpp"
#include "core/system/whole_file.hpp"
#include "mission/xml/text_file.hpp"

namespace skein::command::compose {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> read(const fs::path& file) {
  try {
    if (!file.empty()) return read_whole_file("what was kept", file, profile::kLargestFile);
  } catch (const Error&) {  // there is none
  }
  return std::nullopt;
}

void write(const fs::path& file, const std::string& text) {
  if (file.empty()) throw Unavailable("neither HOME nor XDG_STATE_HOME says where");
  std::error_code failure;
  fs::create_directories(file.parent_path(), failure);
  if (failure) throw Unavailable(file.parent_path().string() + ": " + failure.message());
  write_whole_file("what is kept of the mission", file, text);
}

}  // namespace

/// Empty: there is no folder for it.
fs::path KeptState::file(const char* kind) const {
  const fs::path state = state_folder();
  return state.empty() ? state : state / kind / mission_.relative_path();
}

KeptState::Places KeptState::read_places() const {
  Places places;
  const auto kept = nlohmann::json::parse(read(file("places")).value_or(""), nullptr, false);
  if (!kept.is_object()) return places;
  for (const auto& [entity, place] : kept.items())
    if (place.is_array() && place.size() == 2 && place[0].is_number() && place[1].is_number())
      places[entity] = {place[0].get<double>(), place[1].get<double>()};
  return places;
}

KeptState::KeptState(fs::path mission) : mission_(std::move(mission)) {
  const fs::path lock = file("locks");
  std::error_code failure;
  if (lock.empty() || (fs::create_directories(lock.parent_path(), failure), failure)) return;
  lock_ = FileDescriptor(::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0600));
  if (lock_ && ::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw Unavailable("another `skein designer` composes " + mission_.string());
}

std::optional<KeptState::Draft> KeptState::read_draft() {
  if (auto text = read(file("drafts"))) draft_ = Draft{std::move(*text), read(file("bases"))};
  return draft_;
}

fs::path KeptState::file_with(const std::string& text) const {
  return draft_ && draft_->text == text ? file("drafts") : "";
}

void KeptState::keep_places(const Places& places) {
  nlohmann::json kept = nlohmann::json::object();
  for (const auto& [entity, place] : places) kept[entity] = {place.x, place.y};
  std::string text = kept.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  if (text == places_) return;
  write(file("places"), text);
  places_ = std::move(text);
}

void KeptState::keep_draft(const std::optional<Draft>& draft) {
  if (draft == draft_) return;
  std::error_code ignored;
  if (draft && (!draft_ || draft->base != draft_->base)) {
    fs::remove(file("bases"), ignored);
    if (draft->base) write(file("bases"), *draft->base);
  }
  if (draft) {
    write(file("drafts"), draft->text);
  } else {
    fs::remove(file("drafts"), ignored);
    fs::remove(file("bases"), ignored);
  }
  draft_ = draft;
}

}  // namespace skein::command::compose
