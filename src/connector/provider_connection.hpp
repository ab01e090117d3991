#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "skein/clock.hpp"
#include "skein/detail/channel.hpp"
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
  bool wait = true;              ///< Until a provider appears; otherwise only those that stand now.
};

}  // namespace skein::connector
