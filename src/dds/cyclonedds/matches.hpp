#pragma once

#include <dds/dds.h>

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include "skein/guid.hpp"

namespace skein::dds::cyclonedds {

/// Who is matched with one endpoint. Cyclone's listeners name peers by local handles, and once a
/// peer has gone its handle tells nothing more: so each change is found by comparing whole lists.
///
/// Cyclone tells of a writer some 100 us before it delivers the writer's samples. What a volatile
/// writer sends in that moment is lost: a session's opening is repeated for that reason.
class Matches {
 public:
  using Told = std::function<void(const Guid& peer, bool)>;
  /// Like dds_get_matched_publications(): fills in handles of peers, returns how many there are, or
  /// an error.
  using List = std::function<dds_return_t(dds_instance_handle_t*, std::size_t)>;
  /// A peer's GUID; nil where it has gone meanwhile.
  using Identify = std::function<Guid(dds_instance_handle_t)>;

  Matches(List list, Identify identify, Told on_matched, Told on_liveliness = {});

  /// Compares and tells. From listeners, and once after creation: whatever happened before is told
  /// then.
  void update();

  void liveliness_changed(dds_instance_handle_t peer, bool alive);

  std::vector<Guid> current() const;

 private:
  std::optional<std::vector<dds_instance_handle_t>> handles() const;
  std::vector<std::pair<Guid, bool>> compare();

  const List list_;
  const Identify identify_;
  const Told on_matched_;
  const Told on_liveliness_;
  std::mutex telling_;  // one call at a time
  mutable std::mutex mutex_;
  std::map<dds_instance_handle_t, Guid> peers_;
  std::set<dds_instance_handle_t> silent_;
};

}  // namespace skein::dds::cyclonedds
