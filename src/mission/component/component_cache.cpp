#include "component_cache.hpp"

#include "component_reader.hpp"
#include "mission/xml/text_file.hpp"
#include "mission/xml/words.hpp"

namespace skein::profile {

std::shared_ptr<const ComponentDescription> ComponentCache::read(const XmlAttribute& named) {
  if (named.value.empty()) return nullptr;
  const auto folder = std::filesystem::path(named.where.file).parent_path();
  const auto path = (folder / named.value).lexically_normal();
  const auto [entry, fresh] = read_.emplace(path, nullptr);
  if (!fresh) return entry->second;
  try {
    const auto root = parse_xml(read_text_file(path), path.string(), findings_);
    entry->second = std::make_shared<const ComponentDescription>(read_component(root, findings_));
  } catch (const DescriptionError& error) {
    findings_.error(named.where, "the component " + in_quotes(named.value) + " cannot be read",
                    "the next finding says why");
    findings_.add_all(error.findings());
  }
  return entry->second;
}

std::set<std::filesystem::path> ComponentCache::files() const {
  std::set<std::filesystem::path> files;
  for (const auto& [path, component] : read_) {
    if (component) files.insert(path);
  }
  return files;
}

}  // namespace skein::profile
