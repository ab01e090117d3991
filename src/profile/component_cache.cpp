#include "component_cache.hpp"

#include "component_reader.hpp"
#include "text_file.hpp"
#include "words.hpp"

namespace skein::profile {

std::shared_ptr<const ComponentDescription> ComponentCache::read(const std::string& file,
                                                                 const SourcePosition& named_at) {
  if (file.empty()) return nullptr;
  const auto path = (folder_ / file).lexically_normal();
  const auto [entry, fresh] = read_.emplace(path, nullptr);
  if (!fresh) return entry->second;
  try {
    const XmlDocument document(read_text_file(path), path.string());
    entry->second =
        std::make_shared<const ComponentDescription>(read_component(document, findings_));
  } catch (const DescriptionError& error) {
    findings_.error(named_at, "the component " + in_quotes(file) + " cannot be read",
                    "the next finding says why");
    findings_.add_all(error.findings());
  }
  return entry->second;
}

}  // namespace skein::profile
