#include "edits.hpp"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>

#include "command/designer/request_members.hpp"
#include "design.hpp"
#include "mission/xml/notation.hpp"
#include "mission/xml/words.hpp"
#include "skein/error.hpp"

namespace skein::command::compose {
namespace {

namespace fs = std::filesystem;
using designer::member;
using designer::text_of;
using profile::in_quotes;
using Json = nlohmann::json;
using Attributes = profile::XmlSource::Attributes;

class EditMaker {
 public:
  EditMaker(const Json& request, const Edited& edited)
      : request_(request),
        source_(edited.source),
        design_(edited.design),
        repository_(edited.repository) {}

  Edit run() const {
    const std::string what = text_of(request_, "do");
    if (what == "set") return set();
    if (what == "parameter") return parameter();
    if (what == "add_entity") return add_entity();
    if (what == "add_csp") return add_csp();
    if (what == "add") return add();
    if (what == "remove") return remove();
    throw InvalidArgument(in_quotes(what) + " cannot be asked for");
  }

 private:
  std::size_t element() const {
    const std::size_t number = designer::count_of(request_, "element");
    if (number < source_.elements().size()) return number;
    throw InvalidArgument("the mission has no such element");
  }

  /// Nothing, if it is null.
  std::optional<std::string> value() const {
    if (member(request_, "value").is_null()) return std::nullopt;
    return text_of(request_, "value");
  }

  /// The schema's rule for the element. Throws InvalidArgument if the element is not allowed.
  const profile::Notation& notation(std::size_t number) const {
    const auto& element = source_.elements()[number];
    const profile::Notation* known = nullptr;
    if (element.parent) {
      known = notation(*element.parent).find_child(element.name);
    } else if (element.name == profile::mission_notation().name) {
      known = &profile::mission_notation();
    }
    if (known) return *known;
    throw InvalidArgument("<" + profile::shortened(element.name) + "> is not known in a mission");
  }

  void demand_attribute(std::size_t number, const std::string& name) const {
    demand(notation(number), name);
  }

  static void demand(const profile::Notation& around, const std::string& name) {
    if (std::ranges::find(around.attributes, name) != around.attributes.end()) return;
    throw InvalidArgument("<" + std::string(around.name) + "> has no " + in_quotes(name) + "; " +
                          profile::remedy_for(name, around.attributes));
  }

  /// As people call it.
  std::string called(std::size_t number) const {
    const auto& element = source_.elements()[number];
    const auto* name = element.find_attribute("name");
    if (!name) name = element.find_attribute("component");
    return element.name + (name ? " " + profile::shortened(name->value) : "");
  }

  Edit set() const {
    const std::size_t number = element();
    const std::string attribute = text_of(request_, "attribute");
    const auto given = value();
    if (given) demand_attribute(number, attribute);
    return {"change " + attribute + " of " + called(number),
            "set " + std::to_string(number) + " " + attribute,
            source_.with_attribute(number, attribute, given)};
  }

  Edit parameter() const {
    const std::size_t number = element();
    const std::string name = text_of(request_, "name");
    const auto given = value();
    Edit edit{"change '" + profile::shortened(name) + "' of " + called(number),
              "parameter " + std::to_string(number) + " " + name,
              {}};
    for (std::size_t i = 0; i < source_.elements().size(); ++i) {
      const auto& child = source_.elements()[i];
      if (child.parent != number || child.name != "parameter") continue;
      const auto* known = child.find_attribute("name");
      if (!known || profile::trimmed(known->value) != name) continue;
      edit.splice = given ? source_.with_attribute(i, "value", given) : source_.without(i);
      return edit;
    }
    if (given)
      edit.splice = source_.with_child(number, "parameter", {{"name", name}, {"value", *given}});
    return edit;
  }

  const KnownComponent& component(const fs::path& file) const {
    const auto& all = repository_.components();
    const auto known = all.find(file);
    if (known == all.end())
      throw InvalidArgument("no component " + in_quotes(file.string()) + " is known");
    if (!known->second.description) throw InvalidArgument(known->second.failure);
    return known->second;
  }

  std::string reference(const fs::path& file) const {
    const auto& all = design_.components;
    const auto known = std::ranges::find(all, file.string(), &ComponentState::file);
    return known == all.end() ? file.string() : known->reference;
  }

  /// Of the element, or the nearest around it.
  std::string inherited(std::optional<std::size_t> number, const char* name) const {
    for (; number; number = source_.elements()[*number].parent)
      if (const auto* given = source_.elements()[*number].find_attribute(name)) return given->value;
    return "";
  }

  /// `FlightController` as `flight_controller`, with a number, if there is one already.
  std::string new_name(const std::string& component) const {
    std::string name;
    const auto is = [&](std::size_t i, int (*kind)(int)) {
      return i < component.size() && kind(static_cast<unsigned char>(component[i])) != 0;
    };
    for (std::size_t i = 0; i < component.size(); ++i) {
      const bool begins =
          is(i, std::isupper) && i > 0 && (!is(i - 1, std::isupper) || is(i + 1, std::islower));
      if (begins && is(i - 1, std::isalnum)) name += '_';
      name += is(i, std::isalnum) ? static_cast<char>(std::tolower(component[i])) : '_';
    }
    std::set<std::string> taken;
    for (const auto& each : source_.elements())
      if (const auto* given = each.find_attribute("name")) taken.insert(given->value);
    std::string free = name;
    for (int i = 2; taken.contains(free); ++i) free = name + "_" + std::to_string(i);
    return free;
  }

  void add_plugin(const KnownComponent& known, std::size_t parent, Attributes& attributes) const {
    if (!known.plugin.empty() && known.plugin != inherited(parent, "plugin"))
      attributes.emplace_back("plugin", known.plugin);
  }

  /// A name in PATH stays; a path gets the slash by which a profile knows one.
  std::string program_reference(const std::string& program) const {
    if (!program.starts_with('/')) return program;
    const std::string way = reference_to(program, fs::path(design_.file).parent_path());
    return way.starts_with('/') ? way : "./" + way;
  }

  Edit add_entity() const {
    const fs::path file = text_of(request_, "component");
    const KnownComponent& known = component(file);
    const std::size_t parent = request_.contains("element") ? element() : 0;
    if (!notation(parent).find_child("peer"))
      throw InvalidArgument("no entity can stand in a " + called(parent));
    const std::string name = new_name(known.description->name);
    Attributes attributes{{"name", name}, {"component", reference(file)}};
    if (known.program.empty()) {
      add_plugin(known, parent, attributes);
    } else {
      attributes.emplace_back("program", program_reference(known.program));
    }
    return {"add " + name, "", source_.with_child(parent, "peer", attributes)};
  }

  /// The subcomponents of the entity's component, and whether the component implements one.
  void demand_slot(std::size_t number, const KnownComponent& known) const {
    const auto& parts = design_.parts;
    const auto part = std::ranges::find_if(parts, [&](const PartState& each) {
      return each.element == static_cast<std::int32_t>(number) && each.csp.empty();
    });
    const auto owner =
        part == parts.end()
            ? design_.components.end()
            : std::ranges::find(design_.components, part->description, &ComponentState::file);
    if (owner == design_.components.end())
      throw InvalidArgument(called(number) + " has no component that says which CSPs it needs");
    std::string slots;
    for (const std::string& slot : owner->subcomponents) {
      if (known.description->find_interface(slot)) return;
      slots += (slots.empty() ? "" : ", ") + slot;
    }
    throw InvalidArgument(known.description->name + " does not fit " + called(number) + ", " +
                          (slots.empty() ? "which has no CSPs" : "whose CSPs implement " + slots));
  }

  static bool is_isolated(const profile::ComponentDescription& description) {
    return std::ranges::any_of(description.interfaces, [](const auto& interface) {
      const auto* const isolated = interface.find_attribute("isolated");
      return isolated && isolated->value == "true";
    });
  }

  Edit add_csp() const {
    const std::size_t peer = element();
    const fs::path file = text_of(request_, "component");
    const KnownComponent& known = component(file);
    demand_slot(peer, known);
    const std::string& name = known.description->name;
    Attributes attributes{{"component", reference(file)}};
    const bool taken = std::ranges::any_of(design_.parts, [&](const PartState& part) {
      return part.csp == name && part.element != kNoElement &&
             design_.elements[part.element].parent == static_cast<std::int32_t>(peer);
    });
    if (taken) attributes.emplace_back("name", new_name(name));
    attributes.emplace_back("process", is_isolated(*known.description) ? "own" : "in");
    add_plugin(known, peer, attributes);
    return {"add " + name + " to " + called(peer), "", source_.with_child(peer, "csp", attributes)};
  }

  Edit add() const {
    const std::size_t parent = element();
    const std::string child = text_of(request_, "child");
    const profile::Notation* const known = notation(parent).find_child(child);
    if (!known)
      throw InvalidArgument("no " + in_quotes(child) + " can stand in a " + called(parent));
    Attributes attributes;
    const Json& given = member(request_, "attributes");
    if (!given.is_object()) throw InvalidArgument("the member 'attributes' is no object");
    for (const auto& [name, ignored] : given.items()) {
      demand(*known, name);
      attributes.emplace_back(name, text_of(given, name.c_str()));
    }
    return {"add a " + child + " to " + called(parent), "",
            source_.with_child(parent, child, attributes)};
  }

  Edit remove() const {
    const std::size_t number = element();
    return {"remove " + called(number), "", source_.without(number)};
  }

  const Json& request_;
  const profile::XmlSource& source_;
  const DesignState& design_;
  const Repository& repository_;
};

}  // namespace

Edit edit_of(const Json& request, const Edited& edited) { return EditMaker(request, edited).run(); }

}  // namespace skein::command::compose
