#include "reconnector.hpp"

#include "provider_pool.hpp"
#include "skein/error.hpp"

namespace skein::connector {

ProviderConnection Reconnector::acquire(ProviderQuery wanted) {
  if (auto connection = pool_.ready(wanted)) return *connection;
  std::lock_guard one_at_a_time(connecting_);
  if (auto connection = pool_.ready(wanted)) return *connection;
  ProviderConnection main = pool_.main();
  // A suspect provider is better than none, but not worth waiting for another.
  const bool fall_back = main.channel->connected() && !wanted.excludes(main.provider);
  if (fall_back) wanted.wait = false;
  if (!main.channel->connected()) wanted.last.push_back(main.provider);
  try {
    ProviderConnection connection = connect_(wanted);
    pool_.keep(connection);
    return connection;
  } catch (const NoProvider& lack) {
    if (fall_back) return main;
    if (wanted.wait) throw;
    throw Unavailable(lack.what());
  } catch (const Error& error) {
    if (!fall_back || !is_refusal(error.code())) throw;
    return main;
  }
}

}  // namespace skein::connector
