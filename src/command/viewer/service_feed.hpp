#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "skein/guid.hpp"
#include "skein/types.idl.hpp"
#include "view/server.hpp"

namespace skein {
class Entity;
class Inspector;
}  // namespace skein

namespace skein::discovery {
struct ServiceDescription;
}

namespace skein::command {

/// The operations of a domain's public services, for clients of a server to call. Used by one
/// thread.
class ServiceFeed {
 public:
  /// All outlive it.
  ServiceFeed(view::Server& server, Entity& entity, Inspector& inspector)
      : server_(server), entity_(entity), inspector_(inspector) {}

  /// Offers what is provided now, but for streams, and takes away what is no more. Asks for types
  /// as TopicFeed::update() does.
  void update();

 private:
  void offer(const discovery::ServiceDescription& service, const types::TypeSystem& types);
  std::vector<view::ServiceId> operations(const discovery::ServiceDescription& service,
                                          const types::TypeSystem& types);
  void note_late(const discovery::ServiceDescription& service);

  view::Server& server_;
  Entity& entity_;
  Inspector& inspector_;
  std::map<Guid, std::vector<view::ServiceId>> offered_;  // by provider
  std::set<Guid> late_;                                   // whose types were not told last
};

}  // namespace skein::command
