#include "provider_pool.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "skein/error.hpp"

namespace skein::connector {
namespace {

bool suits(const ProviderConnection& connection, const ProviderQuery& wanted) {
  return connection.trusted() && !wanted.excludes(connection.provider);
}

}  // namespace

std::optional<ProviderConnection> ProviderPool::ready(const ProviderQuery& wanted) {
  std::optional<ProviderConnection> lost;  // destroyed outside the lock
  std::lock_guard lock(mutex_);
  if (closed_ || suits(main_, wanted)) return main_;
  const auto other =
      std::find_if(others_.begin(), others_.end(),
                   [&](const ProviderConnection& connection) { return suits(connection, wanted); });
  if (other == others_.end()) return std::nullopt;
  const ProviderConnection connection = *other;
  if (!main_.trusted()) {
    std::swap(main_, *other);
    if (!other->channel->connected()) {
      lost = std::move(*other);
      others_.erase(other);
    }
  }
  return connection;
}

void ProviderPool::keep(const ProviderConnection& connection) {
  std::vector<ProviderConnection> ended;  // destroyed outside the lock
  std::lock_guard lock(mutex_);
  const auto lost = std::stable_partition(
      others_.begin(), others_.end(),
      [](const ProviderConnection& other) { return other.channel->connected(); });
  ended.assign(std::make_move_iterator(lost), std::make_move_iterator(others_.end()));
  others_.erase(lost, others_.end());
  if (main_.trusted()) {
    others_.push_back(connection);
  } else {
    const ProviderConnection old = std::exchange(main_, connection);
    (old.channel->connected() ? others_ : ended).push_back(old);
  }
  if (closed_) connection.channel->disconnect();
}

ProviderConnection ProviderPool::main() const {
  std::lock_guard lock(mutex_);
  return main_;
}

bool ProviderPool::connected() const {
  std::lock_guard lock(mutex_);
  return !closed_ && main_.channel->connected();
}

bool ProviderPool::closed() const {
  std::lock_guard lock(mutex_);
  return closed_;
}

void ProviderPool::refuse_if_closed() const {
  if (closed())
    throw Unavailable("no new connection: it was disconnected, or this side's entity has ended");
}

std::vector<ProviderConnection> ProviderPool::close() {
  std::lock_guard lock(mutex_);
  closed_ = true;
  std::vector<ProviderConnection> connections = others_;
  connections.push_back(main_);
  return connections;
}

}  // namespace skein::connector
