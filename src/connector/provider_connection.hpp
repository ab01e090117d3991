#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include "skein/clock.hpp"
#include "skein/detail/channel.hpp"
#include "skein/error.hpp"
#include "skein/guid.hpp"

namespace skein::connector {

/// An open connection to one provider.
struct ProviderConnection {
  Guid provider;
  std::shared_ptr<Channel> channel;
  /// Not heard of for its lease, and not known to be gone.
  std::shared_ptr<std::atomic<bool>> suspect = std::make_shared<std::atomic<bool>>(false);

  bool trusted() const { return channel->connected() && !*suspect; }
};

/// What kind of provider is looked for, and for how long.
struct ProviderQuery {
  Instant deadline;
  std::vector<Guid> last{};      ///< Only where no other answers.
  std::vector<Guid> excluded{};  ///< In no case.
  /// Until a provider appears, and takes the connection; otherwise each that stands is asked once.
  bool wait = true;

  bool excludes(const Guid& provider) const {
    return std::find(excluded.begin(), excluded.end(), provider) != excluded.end();
  }
};

/// No provider stands that may be asked: who may wait waits until that changes.
class NoProvider : public Unavailable {
 public:
  using Unavailable::Unavailable;
};

}  // namespace skein::connector
