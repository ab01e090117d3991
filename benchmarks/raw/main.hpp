#pragma once

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "harness/peer.hpp"
#include "harness/skipped.hpp"
#include "skein/error.hpp"

/// The command line of a raw peer: `server DOMAIN [WAY]`, `client DOMAIN [WAY]`, or
/// `neighbour DOMAIN PEERS`.
namespace skein::benchmarks::raw {

/// One call; nothing where no reply came within `patience`.
using TryCall =
    std::function<std::optional<Content>(const Content&, std::chrono::milliseconds patience)>;

/// Connects as DDS makes one do it: an empty request is repeated until a reply comes; then
/// measures, and obeys `extra`.
inline void run_raw_client(const TryCall& call, Commands extra = {}) {
  constexpr std::chrono::milliseconds kOpenInterval{20};
  constexpr std::chrono::milliseconds kPatience{10'000};
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!call({}, kOpenInterval)) {
    if (std::chrono::steady_clock::now() > end) throw Internal("no first reply within 10 s");
  }
  Client client{[&](const Content& content, const Seen& seen) {
    const auto reply = call(content, kPatience);
    if (!reply) throw Internal("no reply within 10 s");
    seen(*reply);
  }};
  client.extra = std::move(extra);
  run_client(client);
}

/// How a peer calls and serves: by the threading contract and the transport of Skein's back end, or
/// in one way that differs from them.
enum class Way {
  Plain,
  SharedMemory,  ///< `shared_memory`: the vendor's transport of that name beside UDP.
  DataSharing,   ///< `data_sharing`: readers read where writers write.
  Listener,      ///< `listener`: the vendor's thread runs the service and writes the reply.
  Polling,       ///< `polling`: both sides ask for data without a pause.
};

/// The pause of a server that spins: none, but where no request came for a while it leaves the core
/// to the other contenders.
class SpinningPause {
 public:
  void after(bool answered) {
    constexpr std::chrono::milliseconds kSpinning{5};
    const auto now = std::chrono::steady_clock::now();
    if (answered) {
      last_ = now;
    } else if (now - last_ > kSpinning) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

 private:
  std::chrono::steady_clock::time_point last_{};
};

/// Throws Skipped for a way that this vendor does not have.
inline Way parse_way(const std::string& text,
                     std::initializer_list<std::pair<const char*, Way>> ways) {
  if (text.empty()) return Way::Plain;
  for (const auto& [name, way] : ways) {
    if (text == name) return way;
  }
  throw Skipped("this vendor has no '" + text + "'");
}

/// What samples of a topic that is no call's are promised.
enum class Delivery {
  BestEffort,
  Latest,             ///< Reliable; late joiners get the latest.
  LatestOfTheLiving,  ///< And its writer's liveliness is watched, with a lease of 1 s.
};

/// What follows the role on the command line.
struct RawOptions {
  std::uint32_t domain = 0;
  std::string way{};
  std::uint32_t peers = 0;
};

/// `server` serves while the function that it is given runs; `neighbour` is raw/neighbour.hpp's.
inline int raw_main(
    int argc, char** argv,
    const std::function<void(const RawOptions&, const std::function<void()>&)>& server,
    const std::function<void(const RawOptions&)>& client,
    const std::function<void(const RawOptions&)>& neighbour = {}) {
  return run_peer([&] {
    const bool alone = neighbour && argc > 1 && argv[1] == std::string("neighbour");
    if (alone ? argc != 4 : argc != 3 && argc != 4) {
      throw InvalidArgument(std::string(argv[0]) +
                            " server|client DOMAIN [WAY], neighbour DOMAIN PEERS");
    }
    const auto number = [](const char* text) {
      return static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
    };
    if (alone) return neighbour({number(argv[2]), "", number(argv[3])});
    const RawOptions options{number(argv[2]), argc == 4 ? argv[3] : ""};
    if (argv[1] == std::string("server")) {
      server(options, run_server);
    } else {
      client(options);
    }
  });
}

}  // namespace skein::benchmarks::raw
