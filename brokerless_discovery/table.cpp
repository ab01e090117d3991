#include "brokerless_discovery/table.hpp"

#include <algorithm>
#include <cstring>

#include "brokerless_discovery/versions.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "core/system/interface_name.hpp"
#include "skein/constraint.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {
namespace {

Guid provider_of(const ServiceDescription& description) { return {description.provider}; }

std::vector<std::string> names_of(const ServiceDescription& description) {
  std::vector<std::string> names{description.service};
  if (!is_built_in_interface(description.service)) names.push_back(description.entity);
  names.insert(names.end(), description.bases.begin(), description.bases.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

bool in_system(const ServiceDescription& description, const Query& query) {
  return !query.system || *query.system == description.system;
}

bool visible(const ServiceDescription& description, const Query& query) {
  return description.owner.empty() || description.owner == query.asker;
}

bool wanted(const ServiceDescription& description, const Query& query) {
  return query.provider.is_nil() || query.provider == provider_of(description);
}

// No component declares an attribute of these names: they would be no names of the dictionary.
constexpr std::string_view kLeaving = "skein:leaving";
constexpr std::string_view kSharedMemoryCalls = "skein:shared_memory_calls";
constexpr std::string_view kWithLoans = "loans";
constexpr std::string_view kWireNumber = "skein:wire";
constexpr std::size_t kLongestWire = 16;

Entry make_entry(const std::shared_ptr<const ServiceDescription>& description, const Guid& writer,
                 std::size_t weight) {
  return {.description = description,
          .writer = writer,
          .weight = weight,
          .leaving = is_leaving(*description),
          .other_wire = has_other_wire(*description)};
}

bool is_own(const Entry& entry) { return entry.writer.is_nil(); }

// R23.
void check_writer(const Guid& provider, const Guid& writer) {
  if (writer.is_nil() || speaks_for(writer, provider)) return;
  throw Refused(Refusal::Forged, "it is about a provider of another participant, " +
                                     provider.participant().hex().substr(0, 24));
}

void canonicalise(ServiceDescription& description) {
  description.service = canonical_interface_name(description.service);
  for (std::string& base : description.bases) base = canonical_interface_name(base);
  for (std::string& part : description.subcomponents) part = canonical_interface_name(part);
  sort_growing(description);
}

}  // namespace

bool is_leaving(const ServiceDescription& description) noexcept {
  return find_attribute(description, kLeaving) != nullptr;
}

// Nobody finds it by its attributes any more, so they make room.
void mark_leaving(ServiceDescription& description) {
  description.attributes = {{std::string(kLeaving), "true"}};
}

bool offers_shared_memory_calls(const ServiceDescription& description) noexcept {
  return find_attribute(description, kSharedMemoryCalls) != nullptr;
}

bool takes_loans(const ServiceDescription& description) noexcept {
  const std::string* const offer = find_attribute(description, kSharedMemoryCalls);
  return offer && *offer == kWithLoans;
}

void offer_shared_memory_calls(ServiceDescription& description, bool with_loans) {
  description.attributes.push_back(
      {std::string(kSharedMemoryCalls), with_loans ? std::string(kWithLoans) : "true"});
}

bool has_other_wire(const ServiceDescription& description) noexcept {
  const std::string* const number = find_attribute(description, kWireNumber);
  return number && *number != kWire;
}

std::string other_wire(const ServiceDescription& description) {
  return "runs a version of Skein whose wire is number " +
         printable(*find_attribute(description, kWireNumber), kLongestWire) +
         ", and here it is number " + std::string(kWire) +
         ": the two cannot call each other; run versions of one wire on both sides (CHANGELOG.md "
         "gives each version's)";
}

void give_wire(ServiceDescription& description) {
  description.attributes.push_back({std::string(kWireNumber), std::string(kWire)});
}

Table::Changes Table::on_description(ServiceDescription description, const Guid& writer) {
  const Guid provider = provider_of(description);
  check_writer(provider, writer);
  if (ended_processes_.contains(description.process)) return {};
  canonicalise(description);
  const auto found = entries_.find(provider);
  if (found != entries_.end() && is_own(found->second) && !writer.is_nil()) {
    if (*found->second.description != description) contradicted_.insert(provider);
    return {};
  }
  const std::size_t weight = weight_of(description);
  auto shared = std::make_shared<const ServiceDescription>(std::move(description));
  if (found == entries_.end()) {
    take_room(writer, weight);
    Entry& entry = entries_[provider] = make_entry(shared, writer, weight);
    index(entry);
    return {{Change::Kind::Added, shared}};
  }
  Entry& entry = found->second;
  const Change::Kind change = entry.suspect ? Change::Kind::Trusted : Change::Kind::Updated;
  const bool same = *entry.description == *shared;
  exchange_room(entry, writer, weight);
  unindex(entry);
  entry = make_entry(shared, writer, weight);
  index(entry);
  if (same && change == Change::Kind::Updated) return {};
  return {{change, shared}};
}

Table::Changes Table::on_withdrawn(const Guid& provider, const Guid& writer) {
  check_writer(provider, writer);
  const auto found = entries_.find(provider);
  if (found == entries_.end()) return {};
  if (is_own(found->second) && !writer.is_nil()) {
    contradicted_.insert(provider);
    return {};
  }
  const auto gone = found->second.description;
  remove(found);
  return {{Change::Kind::Removed, gone, Departure::Left}};
}

Table::Changes Table::on_writer_alive(const Guid& writer, bool alive) {
  Changes changes;
  for (auto& [provider, entry] : entries_) {
    if (entry.writer != writer || entry.suspect == !alive) continue;
    entry.suspect = !alive;
    changes.push_back({alive ? Change::Kind::Trusted : Change::Kind::Suspect, entry.description});
  }
  return changes;
}

Table::Changes Table::on_writer_gone(const Guid& writer) {
  return remove_if([&](const Entry& entry) { return entry.writer == writer; }, Departure::Lost);
}

Table::Changes Table::on_process_ended(const std::string& process) {
  if (ended_processes_.insert(process).second) ended_in_order_.push_back(process);
  if (ended_in_order_.size() > kMaxEnded) {
    ended_processes_.erase(ended_in_order_.front());
    ended_in_order_.pop_front();
  }
  return remove_if([&](const Entry& entry) { return entry.description->process == process; },
                   Departure::Died);
}

Table::Changes Table::remove_if(auto predicate, Departure departure) {
  Changes changes;
  for (auto position = entries_.begin(); position != entries_.end();) {
    if (!predicate(position->second)) {
      ++position;
      continue;
    }
    changes.push_back({Change::Kind::Removed, position->second.description, departure});
    position = remove(position);
  }
  return changes;
}

Table::Entries::iterator Table::remove(Entries::iterator position) {
  give_back_room(position->second);
  room_again_ = refused_for_room_;
  unindex(position->second);
  return entries_.erase(position);
}

// This peer's own services need none.
bool Table::get_room(const Guid& writer, std::size_t weight) {
  return writer.is_nil() || room_.take(writer.participant(), weight);
}

void Table::take_room(const Guid& writer, std::size_t weight) {
  if (get_room(writer, weight)) return;
  refused_for_room_ = true;
  throw Refused(Refusal::NoRoom,
                "there is no room for it: one participant may have " +
                    std::to_string(Room::kEntriesOfOne) + " descriptions, all together " +
                    std::to_string(Room::kEntriesOfAll) + "; it is asked for again when some go");
}

void Table::give_back_room(const Entry& entry) {
  if (!is_own(entry)) room_.give_back(entry.writer.participant(), entry.weight);
}

void Table::exchange_room(const Entry& entry, const Guid& writer, std::size_t weight) {
  give_back_room(entry);
  try {
    take_room(writer, weight);
  } catch (const Refused&) {
    get_room(entry.writer, entry.weight);  // it had it a moment ago
    throw;
  }
}

bool Table::take_room_again() {
  if (!room_again_) return false;
  refused_for_room_ = false;
  return std::exchange(room_again_, false);
}

std::optional<Guid> Table::writer_of(const Guid& provider) const {
  const auto found = entries_.find(provider);
  if (found == entries_.end()) return std::nullopt;
  return found->second.writer;
}

bool Table::is_leaving(const Guid& provider) const {
  const auto found = entries_.find(provider);
  return found != entries_.end() && found->second.leaving;
}

// Of an entry that has the name, in the system, that was asked for.
bool Table::suits(const Entry& entry, const Query& query) {
  const ServiceDescription& description = *entry.description;
  return !entry.suspect && !entry.leaving && !entry.other_wire && visible(description, query) &&
         !(query.client && !understands(*query.client, description)) &&
         std::all_of(query.constraints.begin(), query.constraints.end(),
                     [&](const Constraint& constraint) { return meets(description, constraint); });
}

Table::Found Table::find(const Query& query) const {
  for (const Constraint& constraint : query.constraints) check(constraint);
  Found found;
  const AttributeIndex* const attribute_index = attribute_index_of(query.name, query.system);
  if (!attribute_index) return found;
  const auto offer = [&](const Entry& entry) {
    if (suits(entry, query)) found.push_back(entry.description);
  };
  if (!query.provider.is_nil()) {
    const auto one = entries_.find(query.provider);
    if (one != entries_.end() && attribute_index->contains(one->second)) offer(one->second);
    return found;
  }
  std::vector<const Entry*> room;
  for (const Entry* entry : attribute_index->candidates(query.constraints, room)) offer(*entry);
  if (!query.preferred_host.empty()) {
    std::stable_partition(found.begin(), found.end(), [&](const auto& description) {
      return description->host == query.preferred_host;
    });
  }
  return found;
}

// Why an entry of the wanted name does not suit; empty where it does, or where it was not asked
// for.
std::string Table::obstacle(const Entry& entry, const Query& query) {
  const ServiceDescription& description = *entry.description;
  const std::string who = description.entity + " (" + description.system + ")";
  if (!wanted(description, query)) return {};
  if (!visible(description, query)) {
    return who + " is managed by " + description.owner + ", and only that entity may use it";
  }
  if (!in_system(description, query))
    return "only " + who + " offers it; name that system to use it";
  if (entry.suspect) return who + " has not been heard of for its lease";
  if (entry.leaving) return who + " is about to leave";
  if (entry.other_wire) return who + " " + other_wire(description);
  const std::string differing = query.client ? difference(*query.client, description) : "";
  if (!differing.empty()) {
    const std::string wanted = canonical_interface_name(query.client->name);
    const auto names = names_of(description);
    const bool has_it = std::find(names.begin(), names.end(), wanted) != names.end();
    if (query.name == description.entity && !has_it) {
      return who + " offers " + scoped_interface_name(description.service) + ", not " +
             scoped_interface_name(wanted);
    }
    const auto in_words = query.differences.find(differing);
    return who + " offers another version of it: " +
           (in_words == query.differences.end() ? differing : in_words->second) +
           "; build both sides from the same IDL (`skein describe " +
           scoped_interface_name(description.service) + "` prints the provider's)";
  }
  for (const Constraint& constraint : query.constraints) {
    if (!meets(description, constraint))
      return who + " does not suit: " + shortfall(description, constraint);
  }
  return {};
}

std::string Table::explain(const Query& query) const {
  const std::string place = query.system ? " in system '" + *query.system + "'" : "";
  const AttributeIndex* const attribute_index = attribute_index_of(query.name, std::nullopt);
  std::string reasons;
  std::vector<const Entry*> room;
  for (const Entry* entry :
       attribute_index ? attribute_index->candidates({}, room) : std::span<const Entry* const>()) {
    const std::string reason = obstacle(*entry, query);
    if (!reason.empty()) reasons += (reasons.empty() ? "" : "; ") + reason;
  }
  if (!reasons.empty()) return "no provider of '" + query.name + "'" + place + ": " + reasons;

  if (is_interface_name(query.name)) {
    const std::string canonical = resolve(query.name);
    for (const auto& [provider, entry] : entries_) {
      const auto& parts = entry.description->subcomponents;
      if (std::find(parts.begin(), parts.end(), canonical) != parts.end() ||
          std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
            return short_interface_name(part) == query.name;
          })) {
        const auto& owner = *entry.description;
        const bool own = query.asker == owner.system + "/" + owner.entity;
        return "no provider of '" + query.name + "'" + place + ": it is a managed interface of " +
               (own ? "this entity, of which no CSP is there"
                    : owner.entity + " (" + owner.system + "), and only that entity may use it");
      }
    }
  }
  std::vector<std::string> known;
  for (const auto& [place, attribute_index] : attribute_indexes_) {
    if (!place.system) known.push_back(place.name);
  }
  for (const auto& [name, list] : short_names_) known.push_back(name);
  std::sort(known.begin(), known.end());
  return "no provider of '" + query.name + "'" + place + ": nothing of that name is known" +
         (query.place.empty() ? "" : " in " + query.place) + suggestion(query.name, known);
}

Table::Found Table::all() const {
  Found found;
  for (const auto& [provider, entry] : entries_) found.push_back(entry.description);
  return found;
}

bool Table::has_suspects() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const auto& entry) { return entry.second.suspect; });
}

std::size_t Table::PlaceHash::operator()(const PlaceView& place) const noexcept {
  constexpr std::hash<std::string_view> hash;
  return hash(place.name) * 31 + (place.system ? hash(*place.system) : 0);
}

const AttributeIndex* Table::find_attribute_index(const PlaceView& place) const {
  const auto found = attribute_indexes_.find(place);
  return found == attribute_indexes_.end() ? nullptr : &found->second;
}

// Null where nothing of that name stands in that system.
const AttributeIndex* Table::attribute_index_of(const std::string& name,
                                                const std::optional<std::string>& system) const {
  if (const AttributeIndex* const attribute_index = find_attribute_index({name, system}))
    return attribute_index;
  if (system && find_attribute_index({name, std::nullopt})) return nullptr;
  return find_attribute_index({resolve(name), system});
}

std::string Table::resolve(const std::string& name) const {
  if (const auto found = short_names_.find(name); found != short_names_.end()) {
    if (found->second.size() == 1) return found->second.begin()->first;
    std::string both;
    for (const auto& [canonical, count] : found->second)
      both += (both.empty() ? "" : " and ") + canonical;
    throw InvalidArgument("'" + name + "' is ambiguous: it may be " + both +
                          "; write the whole name");
  }
  return is_interface_name(name) ? canonical_interface_name(name) : name;
}

void Table::index(const Entry& entry) {
  ++processes_[entry.description->process];
  for (const std::string& name : names_of(*entry.description)) {
    attribute_indexes_[{name, entry.description->system}].add(entry);
    attribute_indexes_[{name, std::nullopt}].add(entry);
    if (name != entry.description->entity) ++short_names_[short_interface_name(name)][name];
  }
}

void Table::take_from_attribute_index(const Place& place, const Entry& entry) {
  const auto attribute_index = attribute_indexes_.find(place);
  attribute_index->second.remove(entry);
  if (attribute_index->second.empty()) attribute_indexes_.erase(attribute_index);
}

void Table::unindex(const Entry& entry) {
  const auto process = processes_.find(entry.description->process);
  if (--process->second == 0) processes_.erase(process);
  for (const std::string& name : names_of(*entry.description)) {
    take_from_attribute_index({name, entry.description->system}, entry);
    take_from_attribute_index({name, std::nullopt}, entry);
    if (name == entry.description->entity) continue;
    const auto shorts = short_names_.find(short_interface_name(name));
    if (--shorts->second[name] == 0) shorts->second.erase(name);
    if (shorts->second.empty()) short_names_.erase(shorts);
  }
}

}  // namespace skein::brokerless_discovery
