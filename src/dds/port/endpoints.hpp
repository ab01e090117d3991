#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>

#include "dds/port/port.hpp"

namespace skein::dds {

enum class Side { Writer, Reader };

/// What decides about a match.
struct Endpoint {
  Side side;
  std::string topic;
  std::string type;
  Qos qos;
  std::string participant{};  ///< The name of its participant; empty where that is not known.
};

class EndpointWatch;

/// All endpoints that a participant knows of, so that its own learn whom they cannot be matched
/// with: vendors tell them neither who nor which values, and nothing of types. Thread-safe.
class Endpoints {
 public:
  void found(const Guid& guid, Endpoint endpoint);
  void lost(const Guid& guid);

 private:
  friend class EndpointWatch;

  std::mutex mutex_;
  std::unordered_map<Guid, Endpoint> known_;
  std::set<EndpointWatch*> watches_;
};

/// Whom one own endpoint cannot be matched with. Vendors match two versions of a type all the same:
/// the back end takes nothing of those that are refused, and counts none of them as matched.
/// Thread-safe.
class EndpointWatch {
 public:
  using Told = std::function<void(const Incompatibility&)>;

  /// `told` is called for all that are known and for those to come, once for each; it may be empty.
  /// `all` outlives it.
  EndpointWatch(Endpoints& all, Endpoint own, Told told);
  /// Waits until `told` does not run.
  ~EndpointWatch();
  EndpointWatch(const EndpointWatch&) = delete;
  EndpointWatch& operator=(const EndpointWatch&) = delete;

  /// Whether a back end needs one: who tells no version of the type cannot be refused for it.
  static bool is_needed(const Qos& own, bool tells) { return tells || own.type.signature != 0; }

  void consider(const Guid& peer, const Endpoint& endpoint);
  bool refuses(const Guid& peer) const;

 private:
  Endpoints& all_;
  const Endpoint own_;
  const Told told_;
  mutable std::mutex mutex_;
  std::set<Guid> refused_;
  std::atomic<bool> any_{false};
};

}  // namespace skein::dds
