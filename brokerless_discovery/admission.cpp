#include "brokerless_discovery/admission.hpp"

#include <algorithm>
#include <string_view>

#include "brokerless_discovery/process_watch.hpp"
#include "core/system/interface_name.hpp"
#include "dds/port/options_check.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::brokerless_discovery {
namespace {

constexpr std::size_t kMaxName = dds::kLongestName;
constexpr std::size_t kMaxValue = 4096;

// Control characters reach people's terminals. Those that UTF-8 writes with two bytes count, too.
bool is_control(std::string_view text, std::size_t place) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  return at(place) < 0x20 || at(place) == 0x7F ||
         (at(place) == 0xC2 && place + 1 < text.size() && at(place + 1) < 0xA0);
}

bool has_control(std::string_view text, std::string_view allowed = {}) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_control(text, i) && allowed.find(text[i]) == std::string_view::npos) return true;
  }
  return false;
}

void check_count(const char* what, std::size_t count, std::size_t most) {
  if (count <= most) return;
  throw Refused(Refusal::Oversized, "it has " + std::to_string(count) + " " + what +
                                        ", more than " + std::to_string(most));
}

void check_text(const char* what, const std::string& text, std::size_t most = kMaxName) {
  if (text.size() > most) {
    throw Refused(Refusal::Oversized, std::string(what) + " has " + std::to_string(text.size()) +
                                          " characters, more than " + std::to_string(most));
  }
  if (has_control(text)) {
    throw Refused(Refusal::Malformed, std::string(what) + " holds control characters");
  }
}

void check_announced_name(const char* what, const std::string& name) {
  check_text(what, name);
  if (!is_name(name)) throw Refused(Refusal::Malformed, std::string(what) + " is no name");
}

// Its topics' names, and their types' names, begin with it.
void check_interface(const std::string& name) {
  constexpr const char* kLongestEnd = "_Request";
  check_text("its interface", name);
  if (!dds::is_topic_name(canonical_interface_name(name) + kLongestEnd) ||
      !dds::is_type_name(scoped_interface_name(name) + kLongestEnd)) {
    throw Refused(Refusal::Malformed, "no topic can have the name of its interface");
  }
}

void check_owner(const std::string& owner) {
  if (owner.empty()) return;
  const auto slash = owner.find('/');
  check_announced_name("its owner's system", owner.substr(0, slash));
  check_announced_name("its owner", slash == std::string::npos ? "" : owner.substr(slash + 1));
}

}  // namespace

bool is_name(const std::string& text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !text.empty() && text.size() <= kMaxName && std::all_of(text.begin(), text.end(), allowed);
}

void check_description(const discovery::ServiceDescription& description, const Guid& participant) {
  if (!speaks_for(participant, {description.provider})) {
    throw Refused(Refusal::Forged, "its provider is another participant's");
  }
  if (!description.process.empty() &&
      !ProcessWatch::is_address_of(participant, description.process)) {
    throw Refused(Refusal::Forged, "the process that it names is another participant's");
  }
  check_count("bases", description.bases.size(), kMaxBases);
  check_count("operations", description.operations.size(), kMaxOperations);
  check_count("members of types that may grow", description.growing.size(), kMaxGrowing);
  check_count("subcomponents", description.subcomponents.size(), kMaxBases);
  check_count("attributes", description.attributes.size(), kMaxAttributes);
  check_announced_name("its system", description.system);
  check_announced_name("its entity", description.entity);
  check_owner(description.owner);
  check_interface(description.service);
  for (const auto& base : description.bases) check_text("a base", base);
  for (const auto& part : description.subcomponents) check_text("a subcomponent", part);
  for (const auto& operation : description.operations) check_text("an operation", operation.name);
  for (const auto& attribute : description.attributes) {
    check_text("an attribute's name", attribute.name);
    check_text("an attribute's value", attribute.value, kMaxValue);
  }
  check_text("its host", description.host);
  check_text("its vendor", description.vendor);
  check_count("characters of XML", description.component.size(), kMaxDescriptionBytes);
  if (has_control(description.component, "\t\r\n")) {
    throw Refused(Refusal::Malformed, "its XML holds control characters");
  }
}

std::size_t weight_of(const discovery::ServiceDescription& description) {
  // The table keeps each name twice, with what stands under it.
  constexpr std::size_t kEntry = 1024;
  constexpr std::size_t kPlace = 512;
  constexpr std::size_t kText = 64;
  std::size_t weight = kEntry + description.component.size() + description.service.size() +
                       description.entity.size() + description.owner.size() +
                       description.growing.size() * sizeof(discovery::GrowingMember);
  for (const auto& base : description.bases) weight += kPlace + 4 * base.size();
  for (const auto& part : description.subcomponents) weight += kText + part.size();
  for (const auto& operation : description.operations) weight += kText + operation.name.size();
  for (const auto& attribute : description.attributes) {
    weight += kPlace + 2 * attribute.name.size() + attribute.value.size();
  }
  return weight;
}

bool Room::take(const Guid& participant, std::size_t bytes) {
  if (all_.entries >= kEntriesOfAll || all_.bytes + bytes > kBytesOfAll) return false;
  const auto found = participants_.find(participant);
  if (found != participants_.end() &&
      (found->second.entries >= kEntriesOfOne || found->second.bytes + bytes > kBytesOfOne)) {
    return false;
  }
  for (Taken* taken : {&participants_[participant], &all_}) {
    ++taken->entries;
    taken->bytes += bytes;
  }
  return true;
}

void Room::give_back(const Guid& participant, std::size_t bytes) {
  const auto found = participants_.find(participant);
  for (Taken* taken : {&found->second, &all_}) {
    --taken->entries;
    taken->bytes -= bytes;
  }
  if (found->second.entries == 0) participants_.erase(found);
}

}  // namespace skein::brokerless_discovery
