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

  /// Offers what is provided now, but for streams, and takes away what is no more. Asks for the
  /// types of those that are new, and ends with the first that is not told, as
  /// TopicFeed::update() does.
  void update();

 private:
  /// False where the types were not told.
  bool offer(const discovery::ServiceDescription& service);
  std::vector<view::ServiceId> offer(const discovery::ServiceDescription& service,
                                     const types::TypeSystem& types);

  view::Server& server_;
  Entity& entity_;
  Inspector& inspector_;
  std::map<Guid, std::vector<view::ServiceId>> offered_;  // by provider
  std::set<Guid> late_;                                   // whose types were not told
};

}  // namespace skein::command
