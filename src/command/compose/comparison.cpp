#include "comparison.hpp"

#include <algorithm>

#include "differences.hpp"
#include "mission/xml/text_file.hpp"
#include "repository.hpp"
#include "skein/error.hpp"

namespace skein::command::compose {
namespace {

profile::XmlNode parsed(const std::string& text, const std::filesystem::path& file) {
  profile::FindingList ignored;
  return profile::parse_xml(text, file.string(), ignored);
}

const char* to_word(Difference::Kind kind) {
  if (kind == Difference::Kind::New) return "new";
  return kind == Difference::Kind::Gone ? "gone" : "changed";
}

}  // namespace

bool Comparison::may_read(const std::filesystem::path& file) const {
  return std::ranges::any_of(folders_, [&](const std::filesystem::path& folder) {
    const auto way = whole_path(file).lexically_relative(whole_path(folder));
    return !way.empty() && *way.begin() != "..";
  });
}

void Comparison::compare_with(const std::filesystem::path& file) {
  if (!file.empty()) {
    if (!may_read(file))
      throw InvalidArgument(file.string() + " is in none of the folders that this page may read");
    (void)parsed(profile::read_text_file(file), file);
  }
  file_ = file;
}

void Comparison::tell(DesignState& design) const try {
  design.compared = file_.string();
  design.differences.clear();
  if (file_.empty() || design.elements.empty() || !may_read(file_)) return;
  const auto before = parsed(profile::read_text_file(file_), file_);
  for (const Difference& each : differences(before, parsed(design.text, design.file)))
    design.differences.push_back({to_word(each.kind), each.entity, each.whole, each.text});
} catch (const Error&) {
  design.differences.clear();
}

}  // namespace skein::command::compose
