#include "design.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ranges>
#include <set>

#include "mission/check/profile_check.hpp"
#include "mission/profile/composition.hpp"
#include "mission/xml/xml_source.hpp"
#include "skein/error.hpp"

namespace skein::command::compose {
namespace {

namespace fs = std::filesystem;
using designer::EntityState;
using designer::Link;
using designer::ServiceState;
using profile::Severity;

std::string box_of(const profile::PeerProfile& peer) { return peer.system + "/" + peer.name; }

ServiceState service(const std::string& name, const std::string& csp, const char* state) {
  ServiceState made;
  made.name = name;
  made.csp = csp;
  made.state = state;
  return made;
}

class DesignMaker {
 public:
  DesignMaker(const profile::XmlSource& source, const fs::path& file,
              const profile::MissionProfile& mission)
      : source_(source), file_(file), mission_(mission), composition_(mission) {}

  DesignState run(const std::vector<profile::Finding>& findings, const Repository& repository) {
    add_elements();
    for (const auto& peer : mission_.peers) add_parts(peer);
    for (const auto& finding : findings) add_finding(finding);
    for (std::size_t i = 0; i < mission_.peers.size(); ++i) add_entity(i);
    add_components(repository);
    for (const auto& entry : mission_.dictionary.entries()) add_meaning(entry);
    return std::move(design_);
  }

 private:
  void add_elements() {
    int line = 1;
    std::size_t counted = 0;
    for (const auto& element : source_.elements()) {
      const auto begin = source_.text().begin();
      line +=
          static_cast<int>(std::count(begin + static_cast<std::ptrdiff_t>(counted),
                                      begin + static_cast<std::ptrdiff_t>(element.begin), '\n'));
      counted = element.begin;
      ElementState& state = design_.elements.emplace_back();
      state.name = element.name;
      state.parent = element.parent ? static_cast<std::int32_t>(*element.parent) : kNoElement;
      state.line = static_cast<std::uint32_t>(line);
      for (const auto& each : element.attributes)
        state.attributes.push_back({each.name, each.value});
    }
  }

  std::int32_t element_at(const profile::SourcePosition& where) const {
    if (where.file != file_.string()) return kNoElement;
    if (where.line == 0) return 0;
    const auto found = source_.element_at(where.line, where.column);
    return found ? static_cast<std::int32_t>(*found) : kNoElement;
  }

  void add_parts(const profile::PeerProfile& peer) {
    add_part(element_at(peer.where), box_of(peer), "", peer.component.get());
    for (const auto& csp : peer.csps)
      add_part(element_at(csp.where), box_of(peer), csp.name, csp.component.get());
  }

  void add_part(std::int32_t element, const std::string& entity, const std::string& csp,
                const profile::ComponentDescription* component) {
    PartState part{element, entity, csp, ""};
    if (component) {
      const fs::path file = whole_path(component->where.file);
      used_[file] = component;
      part.description = file.string();
    }
    design_.parts.push_back(std::move(part));
  }

  /// A finding in a component description concerns each entity that uses the component.
  std::int32_t element_of(const profile::SourcePosition& where) const {
    const std::int32_t own = element_at(where);
    if (own != kNoElement) return own;
    const std::string file = whole_path(where.file).string();
    const auto part = std::ranges::find(design_.parts, file, &PartState::description);
    return part == design_.parts.end() ? kNoElement : part->element;
  }

  void add_finding(const profile::Finding& finding) {
    profile::SourcePosition where = finding.where;
    where.file = reference_to(whole_path(where.file), whole_path(file_).parent_path());
    design_.findings.push_back({std::string(to_string(finding.severity)), to_text(where),
                                element_of(finding.where), with_short_paths(finding.problem),
                                with_short_paths(finding.remedy)});
  }

  /// Of files beside the mission.
  std::string with_short_paths(std::string text) const {
    const std::string folder = file_.parent_path().string() + "/";
    for (std::size_t at = 0; (at = text.find(folder, at)) != std::string::npos;)
      text.erase(at, folder.size());
    return text;
  }

  bool is_in(std::int32_t element, std::int32_t around) const {
    for (; element != kNoElement; element = design_.elements[element].parent)
      if (element == around) return true;
    return false;
  }

  /// The first error in the entity's element.
  std::string error_of(const profile::PeerProfile& peer) const {
    const std::int32_t element = element_at(peer.where);
    if (element == kNoElement) return "";
    const auto found = std::ranges::find_if(design_.findings, [&](const FindingState& finding) {
      return finding.severity == to_string(Severity::Error) && is_in(finding.element, element);
    });
    return found == design_.findings.end() ? "" : found->problem;
  }

  void add_entity(std::size_t number) {
    const profile::PeerProfile& peer = mission_.peers[number];
    EntityState entity;
    entity.name = box_of(peer);
    entity.system = peer.system;
    entity.host = peer.host;
    entity.vendor = peer.vendor;
    entity.program = peer.start.program;
    entity.reason = error_of(peer);
    entity.state = entity.reason.empty() ? "planned" : "incomplete";
    if (peer.component) {
      for (const auto& each : peer.component->interfaces)
        entity.services.push_back(service(each.type, "", "planned"));
    }
    add_links(number, entity);
    if (peer.component && peer.start.program.empty()) add_slots(peer, entity);
    for (const auto& csp : peer.csps) {
      const bool known = csp.component && !csp.component->interfaces.empty();
      entity.services.push_back(
          service(known ? csp.component->interfaces[0].type : "", csp.name, "planned"));
    }
    design_.entities.push_back(std::move(entity));
  }

  static void add_slots(const profile::PeerProfile& peer, EntityState& entity) {
    for (const auto& slot : peer.component->subcomponents) {
      const bool filled = std::ranges::any_of(peer.csps, [&](const profile::CspProfile& csp) {
        return csp.component && csp.component->find_interface(slot.type);
      });
      if (!filled) entity.services.push_back(service(slot.type, "", "slot"));
    }
  }

  /// To the providers in its own system; if there are none, to all providers.
  void add_links(std::size_t number, EntityState& entity) {
    std::set<std::string> told;
    for (const auto& need : composition_.needs(number)) {
      if (!told.insert(need.interface).second) continue;
      const auto& all = composition_.providers(need.interface);
      if (all.empty()) entity.services.push_back(service(need.interface, "", "needed"));
      const auto is_near = [&](std::size_t provider) {
        return mission_.peers[provider].system == mission_.peers[number].system;
      };
      const bool near = std::ranges::any_of(all, is_near);
      for (const std::size_t provider : all) {
        if (provider == number || (near && !is_near(provider))) continue;
        Link& link = design_.links.emplace_back();
        link.source = entity.name;
        link.target = box_of(mission_.peers[provider]);
        link.kind = designer::LinkKind::Calls;
        link.name = need.interface;
        link.state = "planned";
      }
    }
  }

  void add_components(const Repository& repository) {
    for (const auto& [file, known] : repository.components()) {
      if (!used_.contains(file)) add_component(file, known.description.get(), known.failure);
    }
    for (const auto& [file, component] : used_) add_component(file, component, "");
    std::ranges::sort(design_.components, {}, &ComponentState::name);
  }

  void add_component(const fs::path& file, const profile::ComponentDescription* component,
                     const std::string& failure) {
    ComponentState state;
    state.file = file.string();
    state.reference = reference_to(file, whole_path(file_).parent_path());
    state.name = component ? component->name : file.stem().string();
    state.failure = failure;
    if (component) describe(*component, state);
    design_.components.push_back(std::move(state));
  }

  static void describe(const profile::ComponentDescription& component, ComponentState& state) {
    for (const auto& each : component.interfaces) {
      state.interfaces.push_back(each.type);
      for (const auto& attribute : each.attributes)
        state.attributes.push_back({attribute.name, attribute.value});
    }
    for (const auto& each : component.dependencies) state.dependencies.push_back(each.type);
    for (const auto& each : component.subcomponents) state.subcomponents.push_back(each.type);
    const auto required = component.required_parameters();
    for (const profile::Parameter* each : component.parameters())
      state.parameters.push_back({each->name, std::ranges::count(required, each) > 0});
  }

  void add_meaning(const profile::DictionaryEntry& entry) {
    if (entry.kind != profile::EntryKind::Parameter) return;
    MeaningState& meaning = design_.dictionary.emplace_back();
    meaning.name = entry.name;
    meaning.type = to_string(entry.type);
    meaning.unit = entry.unit;
    if (entry.minimum) meaning.minimum.push_back(*entry.minimum);
    if (entry.maximum) meaning.maximum.push_back(*entry.maximum);
    meaning.documentation = entry.documentation;
  }

  const profile::XmlSource& source_;
  const fs::path& file_;
  const profile::MissionProfile& mission_;
  const profile::Composition composition_;
  std::map<fs::path, const profile::ComponentDescription*> used_;
  DesignState design_;
};

}  // namespace

std::string reference_to(const fs::path& file, const fs::path& folder) {
  const fs::path way = file.lexically_relative(folder);
  const auto up = std::ranges::count(way, fs::path(".."));
  const auto depth = std::ranges::distance(folder.relative_path());
  return way.empty() || up >= depth ? file.string() : way.string();
}

std::vector<profile::Finding> findings_in(const std::string& json) try {
  std::vector<profile::Finding> findings;
  for (const auto& each : nlohmann::json::parse(json)) {
    profile::Finding& finding = findings.emplace_back();
    finding.where = {each.at("file"), each.at("line"), each.at("column")};
    for (const Severity severity : {Severity::Note, Severity::Warning, Severity::Error})
      if (each.at("severity") == to_string(severity)) finding.severity = severity;
    finding.problem = each.at("problem");
    finding.remedy = each.at("remedy");
  }
  return findings;
} catch (const nlohmann::json::exception&) {
  throw Unavailable("`skein check` did not tell what it finds");
}

DesignState design_of(const std::string& text, const fs::path& file,
                      const profile::VariableValues& values, const Repository& repository,
                      const std::vector<profile::Finding>* checked) {
  std::vector<profile::Finding> findings;
  const auto mission = profile::read_and_check(file, findings, values, {}, &text);
  if (checked) findings = *checked;
  std::optional<profile::XmlSource> source;
  try {
    source.emplace(text, file.string());
  } catch (const profile::DescriptionError&) {  // which is among the findings
    DesignState broken;
    for (const auto& finding : findings)
      broken.findings.push_back({std::string(to_string(finding.severity)), to_text(finding.where),
                                 kNoElement, finding.problem, finding.remedy});
    return broken;
  }
  return DesignMaker(*source, file, mission).run(findings, repository);
}

}  // namespace skein::command::compose
