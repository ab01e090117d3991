#pragma once

#include <exception>

#include "provider_connection.hpp"

namespace skein::connector {

/// How often, and by whom, one call to an idempotent operation may still be tried. Not thread-safe.
class Retries {
 public:
  explicit Retries(Instant deadline) { wanted_.deadline = deadline; }

  /// Whether another provider may do what `provider` failed to do. Notes who failed: who refused is
  /// not asked again; who was lost may be, once more, where nobody else is available.
  bool admit(const std::exception_ptr& error, const Guid& provider, Instant now);

  /// Who is to be asked next; before the first failure, anybody who comes.
  const ProviderQuery& wanted() const noexcept { return wanted_; }

 private:
  ProviderQuery wanted_;
  int failures_ = 0;
};

}  // namespace skein::connector
