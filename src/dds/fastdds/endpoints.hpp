#pragma once

#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "dds/port.hpp"
#include "events.hpp"

namespace skein::dds::fastdds {

enum class Side { Writer, Reader };

/// What decides about a match.
struct Endpoint {
  Side side;
  std::string topic;
  std::string type;
  Qos qos;
};

/// All endpoints that a participant knows of, so that its own learn whom they cannot be matched
/// with. Fast DDS tells them neither who nor which values. Thread-safe.
class Endpoints {
 public:
  void found(const Guid& guid, Endpoint endpoint);
  void lost(const Guid& guid);

  /// An own endpoint, told of all that are known, and of those to come until it closes.
  void watch(const Endpoint& endpoint, const std::shared_ptr<EndpointEvents>& events);

 private:
  struct Watcher {
    Endpoint endpoint;
    std::weak_ptr<EndpointEvents> events;
    std::set<Guid> told{};
  };

  static void compare(Watcher& watcher, const Guid& guid, const Endpoint& endpoint);

  std::mutex mutex_;
  std::unordered_map<Guid, Endpoint> known_;
  std::vector<Watcher> watchers_;
};

}  // namespace skein::dds::fastdds
