#include "service_versions.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "core/growth.hpp"
#include "core/system/interface_name.hpp"
#include "idl/types/type_difference.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::command::doctor {
namespace {

using discovery::OperationDigest;
using discovery::ServiceDescription;

struct Provider {
  const PeerPicture* peer;
  const ServiceDescription* service;

  std::string place() const { return "at " + service->system + "/" + service->entity; }
};

/// An operation that both have is another one, or a type that grows is.
bool exclude_each_other(const ServiceDescription& one, const ServiceDescription& other) {
  const auto differs = [&](const OperationDigest& mine) {
    const auto there = std::ranges::find(other.operations, mine.hash, &OperationDigest::hash);
    return there != other.operations.end() && there->signature != mine.signature;
  };
  return std::ranges::any_of(one.operations, differs) ||
         find_difference(one.growing, other.growing).has_value();
}

std::optional<std::string> asked_difference_between(const Provider& one, const Provider& other,
                                                    const TellTypes& tell_types) {
  if (!tell_types) return std::nullopt;
  const auto told_by = [&](const Provider& provider) {
    KnownTopic::Endpoint asked{provider.peer->participant, provider.peer->name, {}};
    asked.told.type = provider.service->service;
    return tell_types(asked);
  };
  const auto here = told_by(one);
  const auto there = here ? told_by(other) : std::nullopt;
  if (!there) return std::nullopt;
  const auto found =
      idl::difference_of_interfaces(scoped_interface_name(one.service->service), *here, *there);
  if (!found) return std::nullopt;
  return idl::in_words(*found, one.place(), other.place());
}

std::string told_conflict(const Provider& one, const Provider& other, const TellTypes& tell_types) {
  const auto difference = asked_difference_between(one, other, tell_types);
  return "service '" + scoped_interface_name(one.service->service) + "': the providers " +
         one.place() + " and " + other.place() +
         " have different versions of it, and a client of one does not call the other" +
         (difference ? ": " + *difference : "");
}

}  // namespace

std::vector<std::string> service_conflicts(const DomainPicture& picture,
                                           const TellTypes& tell_types) {
  // By system, owner and interface: a client finds those of one place.
  std::map<std::vector<std::string>, std::vector<Provider>> places;
  for (const PeerPicture& peer : picture) {
    for (const auto& service : peer.services)
      places[{service->system, service->owner, service->service}].push_back({&peer, service.get()});
  }
  std::vector<std::string> sentences;
  for (const auto& [place, providers] : places) {
    for (std::size_t i = 1; i < providers.size(); ++i) {
      if (exclude_each_other(*providers[0].service, *providers[i].service))
        sentences.push_back(told_conflict(providers[0], providers[i], tell_types));
    }
  }
  return sentences;
}

}  // namespace skein::command::doctor
