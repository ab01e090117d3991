#pragma once

#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "provider_connection.hpp"

namespace skein::connector {

/// The open connections to the providers of one interface, and the one among them that calls
/// prefer. Connects to nobody. Thread-safe.
class ProviderPool {
 public:
  explicit ProviderPool(ProviderConnection first) : main_(std::move(first)) {}

  /// A connection to a trusted provider that stands now, or nothing. After close() the main one,
  /// which refuses the call.
  std::optional<ProviderConnection> ready(const ProviderQuery& wanted);

  /// Adds a new connection. It replaces a main one that is lost or suspect; beside one that stands,
  /// it is kept for the next call that needs it.
  void keep(const ProviderConnection& connection);

  ProviderConnection main() const;
  bool connected() const;

  bool closed() const;
  /// Throws Unavailable after close().
  void refuse_if_closed() const;
  /// Returns all connections for the caller to end. One that keep() adds later is disconnected.
  std::vector<ProviderConnection> close();

 private:
  mutable std::mutex mutex_;                // guards the members below
  ProviderConnection main_;                 // calls prefer it as long as it is trusted
  std::vector<ProviderConnection> others_;  // opened for calls that the main one failed
  bool closed_ = false;
};

}  // namespace skein::connector
