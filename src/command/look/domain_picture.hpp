#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "brokerless_discovery/broker.hpp"
#include "skein/guid.hpp"
#include "skein/inspector.hpp"

namespace skein {
class Entity;
}

namespace skein::command {

/// A peer as others see it, and as it describes itself.
struct PeerPicture {
  std::string name;  ///< `system/entity`; of a CSP that only the Broker knows, its owner's.
  Guid participant;
  std::optional<inspection::Peer> process;  ///< Nothing: it does not answer.
  /// Its services, managed ones included; sorted by name.
  std::vector<std::shared_ptr<const discovery::ServiceDescription>> services;
  std::vector<inspection::TopicEndpoint> topics;
  std::vector<inspection::Connection> connections;
};

/// The peers on a domain at one moment, ordered by name, without the one that looks.
using DomainPicture = std::vector<PeerPicture>;

/// Puts together what the Broker knows of services, and what peers answer.
class DomainLook {
 public:
  /// `entity` must outlive it. Throws as Inspector.
  DomainLook(Entity& entity, std::function<bool()> gives_up)
      : entity_(entity), inspector_(entity, std::move(gives_up)) {}

  /// Topics and connections only if `whole`. Takes as long as the slowest peer that answers, at
  /// most a second, or two if `whole`.
  DomainPicture take(bool whole);

 private:
  Entity& entity_;
  Inspector inspector_;
};

/// The peer of a picture by its participant; null if there is none.
const PeerPicture* find_peer(const DomainPicture& picture, const Guid& participant);

/// Whether it is one of Skein's commands, and not of a mission.
bool is_tool(const PeerPicture& peer);

}  // namespace skein::command
