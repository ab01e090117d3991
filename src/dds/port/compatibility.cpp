#include "compatibility.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/growth.hpp"
#include "core/printable.hpp"
#include "idl/types/type_text.hpp"
#include "type_version.hpp"

namespace skein::dds {
namespace {

using Period = std::optional<std::chrono::milliseconds>;

std::string text(const Period& period) {
  return period ? std::to_string(period->count()) + " ms" : "none";
}

std::string text(DataRepresentation representation) {
  return representation == DataRepresentation::Xcdr1 ? "XCDR1" : "XCDR2";
}

/// A reader that wants something at least so often is content with more often only.
bool often_enough(const Period& offered, const Period& requested) {
  return !requested || (offered && *offered <= *requested);
}

struct Mismatch {
  const char* policy;
  std::string offered;
  std::string requested;
  const char* remedy;
};

constexpr const char* kSameVersion = "build both sides from the same version of the type";

using Members = std::span<const GrowingMember>;

/// Both lists up to the last member that discovery carries of each, so that both sides compare the
/// same: it cuts off the end of a list that is longer than kMostMembers.
std::pair<Members, Members> comparable(Members ours, Members theirs) {
  const auto place = [](const GrowingMember& member) {
    return std::tuple(member.type, member.member);
  };
  for (const Members& carried : {ours, theirs}) {
    if (carried.size() < kMostMembers) continue;
    const auto last = place(carried[kMostMembers - 1]);
    for (Members* members : {&ours, &theirs}) {
      while (!members->empty() && place(members->back()) > last) {
        *members = members->first(members->size() - 1);
      }
    }
  }
  return {ours, theirs};
}

/// Only the own side's members have names.
std::string name_of(std::uint32_t type, const Members& ours, const Members& theirs) {
  for (const Members& members : {ours, theirs}) {
    const auto found = std::ranges::find_if(members, [&](const GrowingMember& member) {
      return member.type == type && !member.name.empty();
    });
    if (found != members.end()) return std::string(found->name.substr(0, found->name.rfind('.')));
  }
  return "a type";
}

std::optional<Mismatch> find_mismatch(const TypeVersion& offered, const TypeVersion& requested) {
  if (offered.signature == 0 || requested.signature == 0) return std::nullopt;
  if (offered.signature != requested.signature) {
    if (auto texts = idl::difference_of_texts(offered.text, requested.text)) {
      return Mismatch{"type", std::move(texts->first), std::move(texts->second), kSameVersion};
    }
    return Mismatch{"type", "version " + hexadecimal(offered.signature, 16),
                    "version " + hexadecimal(requested.signature, 16), kSameVersion};
  }
  const auto both = comparable(offered.members, requested.members);
  const Members& ours = both.first;
  const Members& theirs = both.second;
  const auto found = find_difference(ours, theirs);
  if (!found) return std::nullopt;
  const std::uint32_t type = (found->here ? found->here : found->there)->type;
  const auto named = [&](const GrowingMember* member) {
    return member && !member->name.empty() ? std::string(member->name)
                                           : "a member of " + name_of(type, ours, theirs);
  };
  if (!found->here) {
    return Mismatch{"type", "none", named(found->there) + ", which must be understood",
                    kSameVersion};
  }
  if (!found->there) {
    return Mismatch{"type", named(found->here) + ", which must be understood", "none",
                    kSameVersion};
  }
  const std::string name = named(found->here->name.empty() ? found->there : found->here);
  return Mismatch{"type", name + " in version " + hexadecimal(found->here->digest, 8),
                  name + " in version " + hexadecimal(found->there->digest, 8), kSameVersion};
}

std::optional<Mismatch> find_mismatch(const Qos& offered, const Qos& requested) {
  if (requested.reliable && !offered.reliable) {
    return Mismatch{"reliability", "best effort", "reliable",
                    "make the writer reliable or the reader best effort"};
  }
  if (requested.transient_local && !offered.transient_local) {
    return Mismatch{"durability", "volatile", "transient-local",
                    "make the writer transient-local or the reader volatile"};
  }
  if (!often_enough(offered.deadline, requested.deadline)) {
    return Mismatch{"deadline", text(offered.deadline), text(requested.deadline),
                    "give the writer a deadline that is no longer than the reader's"};
  }
  if (!often_enough(offered.liveliness_lease, requested.liveliness_lease)) {
    return Mismatch{"liveliness", text(offered.liveliness_lease), text(requested.liveliness_lease),
                    "give the writer a lease that is no longer than the reader's"};
  }
  if (requested.exclusive != offered.exclusive) {
    return Mismatch{"ownership", offered.exclusive ? "exclusive" : "shared",
                    requested.exclusive ? "exclusive" : "shared", "give both sides the same"};
  }
  if (requested.representation != DataRepresentation::Any &&
      requested.representation != offered.representation) {
    return Mismatch{"data representation", text(offered.representation),
                    text(requested.representation),
                    "give both sides the same: in Skein the type decides it"};
  }
  return find_mismatch(offered.type, requested.type);
}

Incompatibility explained(const std::string& topic, const Guid& peer, const Mismatch& mismatch) {
  return {peer, mismatch.policy, mismatch.offered, mismatch.requested,
          "topic '" + topic + "': a writer and a reader do not match in " + mismatch.policy +
              ": the writer offers " + mismatch.offered + ", the reader requests " +
              mismatch.requested + "; " + mismatch.remedy};
}

}  // namespace

bool share_partition(const Qos& writer, const Qos& reader) {
  const std::vector<std::string> standard{""};
  const auto& offered = writer.partitions.empty() ? standard : writer.partitions;
  const auto& wanted = reader.partitions.empty() ? standard : reader.partitions;
  return std::ranges::any_of(offered, [&](const std::string& partition) {
    return std::ranges::find(wanted, partition) != wanted.end();
  });
}

std::optional<Incompatibility> find_incompatibility(const std::string& topic, const Guid& peer,
                                                    const Qos& offered, const Qos& requested) {
  const auto found = find_mismatch(offered, requested);
  if (!found) return std::nullopt;
  return explained(topic, peer, *found);
}

std::optional<Incompatibility> find_other_type(const std::string& topic, const Guid& peer,
                                               const std::string& offered,
                                               const std::string& requested) {
  if (offered == requested) return std::nullopt;
  return explained(topic, peer,
                   {"type", printable(offered), printable(requested),
                    "give both sides the same type, or one of them another topic"});
}

Incompatibility with_other_side(Incompatibility why, const std::string& name) {
  why.explanation +=
      " (the other side is " + (name.empty() ? why.peer.hex() : printable(name)) + ")";
  return why;
}

}  // namespace skein::dds
