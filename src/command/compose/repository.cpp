#include "repository.hpp"

#include <algorithm>

#include "core/printable.hpp"
#include "mission/component/component_reader.hpp"
#include "mission/xml/finding_list.hpp"
#include "mission/xml/text_file.hpp"

namespace skein::command::compose {
namespace {

namespace fs = std::filesystem;

/// A home folder, say, holds more than a person has meant.
constexpr std::size_t kMostFiles = 20'000;
constexpr int kDeepest = 6;
constexpr std::uintmax_t kLargest = 256 << 10;

std::string value_of(const profile::XmlNode& node, const char* name) {
  const auto* const attribute = node.find_attribute(name);
  const bool plain = attribute && attribute->value.find("${") == std::string::npos;
  return plain ? attribute->value : "";
}

std::string first_of(const std::string& one, const std::string& other) {
  return one.empty() ? other : one;
}

/// The plugin that the project beside a description builds for it, as `skein new` writes one; else
/// empty.
std::string built_for(const fs::path& description) try {
  const std::string text = profile::read_text_file(description.parent_path() / "CMakeLists.txt");
  const std::string call = "add_library(";
  const std::size_t end = text.find(" MODULE " + description.stem().string() + ".cpp)");
  const std::size_t begin = end == std::string::npos ? end : text.rfind(call, end);
  if (begin == std::string::npos) return "";
  const std::string target = text.substr(begin + call.size(), end - begin - call.size());
  return target.find_first_of(" \n") == std::string::npos ? target : "";
} catch (const Error&) {
  return "";
}

}  // namespace

fs::path whole_path(const fs::path& path) {
  std::error_code failure;
  const fs::path whole = fs::weakly_canonical(path, failure);
  return failure ? fs::absolute(path).lexically_normal() : whole;
}

/// The folder and plugin that the elements around one give.
struct Repository::Use {
  fs::path folder;
  std::string plugin;
};

void Repository::look() {
  components_.clear();
  uses_.clear();
  troubles_.clear();
  dictionary_.clear();
  idl_folders_.clear();
  for (const fs::path& folder : folders_) look_into(whole_path(folder));
  for (auto& [file, component] : components_) {
    const auto use = uses_.find(file);
    if (use != uses_.end()) std::tie(component.plugin, component.program) = use->second;
    if (component.plugin.empty() && component.program.empty()) component.plugin = built_for(file);
  }
}

void Repository::look_into(const fs::path& folder) {
  std::size_t files = 0;
  std::error_code failure;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied,
                                      failure);
  if (failure) {
    troubles_.push_back("the folder " + printable(folder.string()) +
                        " cannot be read: " + failure.message());
    return;
  }
  std::vector<fs::path> found;
  for (; at != fs::recursive_directory_iterator() && !failure; at.increment(failure)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with('.') || at.depth() == kDeepest) at.disable_recursion_pending();
    if (++files > kMostFiles) {
      troubles_.push_back("only " + std::to_string(kMostFiles) + " files of " +
                          printable(folder.string()) + " were looked at for components: name " +
                          "their folders with --components");
      break;
    }
    std::error_code ignored;
    if (at->path().extension() == ".xml" && at->is_regular_file(ignored) &&
        at->file_size(ignored) <= kLargest)
      found.push_back(at->path());
    if (name.ends_with(".idl") && !name.ends_with(".dds.idl"))  // which Skein has generated
      idl_folders_.insert(whole_path(at->path().parent_path()));
  }
  if (failure) {
    troubles_.push_back("not all of the folder " + printable(folder.string()) +
                        " could be read: " + failure.message());
  }
  std::ranges::sort(found);
  for (const fs::path& file : found) read(whole_path(file));
}

void Repository::read(const fs::path& file) {
  if (components_.contains(file)) return;
  std::string text;
  try {
    text = profile::read_text_file(file);
    profile::FindingList findings;
    const profile::XmlNode root = profile::parse_xml(text, file.string(), findings);
    if (root.name == "dictionary" && dictionary_.empty()) dictionary_ = file;
    if (root.name == "mission" || root.name == "part") add_uses(root, {file.parent_path(), ""});
    if (root.name != "component") return;
    auto description = profile::read_component(root, findings);
    findings.throw_if_errors();
    components_[file].description =
        std::make_shared<const profile::ComponentDescription>(std::move(description));
  } catch (const profile::DescriptionError& error) {
    // Other programs' files are none of ours.
    if (text.find("<component") != std::string::npos) components_[file].failure = error.what();
  }
}

void Repository::add_uses(const profile::XmlNode& node, const Use& around) {
  const Use use{around.folder, first_of(value_of(node, "plugin"), around.plugin)};
  if (const std::string component = value_of(node, "component"); !component.empty()) {
    std::string program = value_of(node, "program");
    if (program.find('/') != std::string::npos) program = whole_path(use.folder / program).string();
    const bool is_csp = node.name == "csp";
    uses_.try_emplace(whole_path(use.folder / component), use.plugin, is_csp ? "" : program);
  }
  for (const auto& child : node.children) add_uses(child, use);
}

}  // namespace skein::command::compose
