#pragma once

#include <functional>
#include <mutex>
#include <utility>

#include "provider_connection.hpp"

namespace skein::connector {

class ProviderPool;

/// Opens a connection when the pool has none that suits, one at a time. Thread-safe.
class Reconnector {
 public:
  /// Blocks while it connects, until the deadline at most. Throws NoProvider, which may change, or
  /// why the last one refused.
  using Connect = std::function<ProviderConnection(const ProviderQuery& wanted)>;

  Reconnector(ProviderPool& pool, Connect connect) : pool_(pool), connect_(std::move(connect)) {}

  /// A connection, newly opened if none stands; a suspect one if no other can be had. Blocks while
  /// it connects, and passes on the errors of `connect`: NoProvider only if waiting helps.
  ProviderConnection acquire(ProviderQuery wanted);

 private:
  ProviderPool& pool_;
  const Connect connect_;
  std::mutex connecting_;
};

}  // namespace skein::connector
