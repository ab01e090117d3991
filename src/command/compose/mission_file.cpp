#include "mission_file.hpp"

#include "core/system/whole_file.hpp"
#include "mission/xml/finding.hpp"
#include "mission/xml/text_file.hpp"
#include "skein/error.hpp"

namespace skein::command::compose {
namespace {

std::optional<std::string> read_if_there(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, ignored))) return std::nullopt;
  return profile::read_text_file(file);
}

}  // namespace

MissionFile::MissionFile(std::filesystem::path file, const std::string& text_if_new)
    : file_(std::move(file)),
      saved_(read_if_there(file_)),
      history_(saved_.value_or(text_if_new)) {}

MissionFile::Disk MissionFile::disk() const {
  std::optional<std::string> now;
  try {
    now = read_if_there(file_);
  } catch (const profile::DescriptionError&) {
    return Disk::Changed;
  } catch (const Unavailable&) {  // nothing can be told for the moment
    return Disk::Same;
  }
  if (now == saved_) return Disk::Same;
  return now ? Disk::Changed : Disk::Gone;
}

void MissionFile::save(bool over) {
  if (!over && disk() == Disk::Changed) {
    throw Unavailable(file_.string() +
                      " was changed by somebody else meanwhile: load that, or save over it");
  }
  std::error_code ignored;
  const auto status = std::filesystem::status(file_, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw Unavailable(file_.string() + " is no regular file any more: move it away");
  write_whole_file("the mission", file_, text());
  saved_ = text();
  history_.seal();
}

void MissionFile::restore(const std::string& text, std::optional<std::string> base) {
  history_.edit(kRestored, "", profile::difference(history_.text(), text));
  saved_ = std::move(base);
}

void MissionFile::load() {
  std::string text = profile::read_text_file(file_);
  history_.edit("load what is on the disk", "", profile::difference(history_.text(), text));
  saved_ = std::move(text);
}

}  // namespace skein::command::compose
