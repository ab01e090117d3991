#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "brokerless_discovery/broker.hpp"
#include "core/recent_set.hpp"
#include "head_parts.hpp"
#include "rpc/service/service.hpp"
#include "skein/selection.hpp"

namespace skein::entity {

/// The CSPs that the Broker knows, of each interface that a Head has had a task for. The Broker is
/// asked again once its table has changed. Thread-safe.
class KnownCsps {
 public:
  /// `parts` outlives it.
  explicit KnownCsps(const Head::Parts& parts) : parts_(parts) {}

  /// Those that may be asked, perhaps none: a CSP in this process that overran its time is not
  /// entered again before it has returned. `only`: as TaskOptions::only.
  std::vector<Candidate> find(const InterfaceInfo& interface, const std::string& only);

  /// The host of a CSP; null if it has just left.
  std::shared_ptr<const std::string> host_of(const InterfaceInfo& interface,
                                             const Guid& provider) const;

  /// Throws NoCandidate: find() gives none.
  [[noreturn]] void refuse(const InterfaceInfo& interface, const std::string& only);

 private:
  /// A CSP as its description tells of it.
  struct Known {
    Candidate candidate;
    std::shared_ptr<const std::string> host;
    std::weak_ptr<rpc::Service> service;  ///< In this process.

    bool hangs() const;
  };

  struct Csps {
    std::uint64_t generation = UINT64_MAX;
    std::vector<Known> known;
  };

  const std::vector<Known>& csps(const InterfaceInfo& interface);
  Known known(const std::shared_ptr<const brokerless_discovery::ServiceDescription>& described);
  void tell_unusable(brokerless_discovery::Query query, std::size_t usable);

  const Head::Parts& parts_;
  mutable std::mutex mutex_;
  std::unordered_map<const InterfaceInfo*, Csps> csps_;
  RecentSet<Guid> told_unusable_{64};
};

}  // namespace skein::entity
