#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "skein/entity.hpp"

namespace skein::benchmarks {

/// One process of a Skein configuration.
struct SkeinPeer {
  std::string role;  ///< `server`, `client`, or `local`: both in one process; `finder`;
                     ///< `head`; `viewer`, `lender`; `neighbour`; `bystander`; or `recorder`,
                     ///< `publisher`, `counter`.
  std::string vendor;
  std::uint32_t domain = 0;
  std::size_t threads = 1;
  std::string interface;       ///< Empty: loopback.
  std::string peer;            ///< Address of the other host, with `interface`.
  bool shared_memory = false;  ///< See EntityOptions::shared_memory_calls.
  bool on_arrival = false;     ///< A server whose service has CallThread::Caller.
  std::uint32_t spin_us = 0;   ///< See EntityOptions::spin.
  bool survives = false;  ///< A server or client that goes through faults (calls/survivor.hpp).
  std::size_t peers =
      0;  ///< Of a `neighbour` or `bystander`: how many there are, itself among them.
};

/// Those of a server or a client. Throws Skipped where its vendor is not installed.
EntityOptions entity_options(const SkeinPeer& peer);

/// Serves, or calls and obeys. Besides `call` a client knows `hold` (starts a call that does not
/// return; answers `holding` when the provider is at it) and `told` (waits for that call's end and
/// for the provider's description to go; answers with the times of both, in ns).
int run_skein_peer(const SkeinPeer& peer);

}  // namespace skein::benchmarks
