#include "value_file.hpp"

#include "mission/xml/text_file.hpp"
#include "mission/xml/words.hpp"
#include "mission/xml/xml_text.hpp"

namespace skein::profile {
namespace {

bool names_file(const std::string& value) {
  return value.starts_with('@') && !value.starts_with("@@");
}

/// Without the white space at its end: what stands before counts in the numbers of lines.
std::string text_of(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    throw DescriptionError({Finding{Severity::Error, {file.string(), 0, 0}, problem, remedy}});
  };
  std::string text = read_text_file(file);
  if (text.size() > kLargestValueFile)
    refuse("is larger than " + std::to_string(kLargestValueFile >> 20) + " MiB, too large a value",
           "shorten it");
  demand_utf8_text(text, file.string());
  text.resize(text.find_last_not_of(" \t\r\n") + 1);
  if (text.empty()) refuse("is empty", "write the value into it");
  return text;
}

}  // namespace

std::string with_whole_path(const std::string& value, const std::filesystem::path& folder) {
  if (!names_file(value)) return value;
  const std::filesystem::path file(trimmed(std::string_view(value).substr(1)));
  return "@" + std::filesystem::absolute(folder / file).lexically_normal().string();
}

std::string assignment_with_whole_path(const std::string& assignment) {
  const std::size_t value = assignment.find('=') + 1;
  return assignment.substr(0, value) + with_whole_path(assignment.substr(value), "");
}

void read_value_file(Setting& setting, FindingList& findings) {
  if (setting.value.starts_with("@@"))
    setting.value.erase(0, 1);
  else if (names_file(setting.value)) {
    setting.file = setting.value.substr(1);
    setting.value.clear();
    try {
      setting.value = text_of(setting.file);
      setting.value_where = {setting.file, 0, 0};
    } catch (const DescriptionError& error) {
      findings.error(setting.value_where,
                     "the value of " + in_quotes(setting.name) + " cannot be read from a file",
                     "the next finding says why; @@ at the beginning of a value stands for @");
      findings.add_all(error.findings());
    }
  }
}

}  // namespace skein::profile
