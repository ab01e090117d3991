#pragma once

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>

#include "harness/peer.hpp"
#include "skein/core/error.hpp"

/// The command line of a raw peer: `server DOMAIN` or `client DOMAIN`.
namespace skein::benchmarks::raw {

/// One call; nothing where no reply came within `patience`.
using TryCall =
    std::function<std::optional<Content>(const Content&, std::chrono::milliseconds patience)>;

/// Connects as DDS makes one do it: an empty request is repeated until a reply comes; then
/// measures.
inline void run_raw_client(const TryCall& call) {
  constexpr std::chrono::milliseconds kOpenInterval{20};
  constexpr std::chrono::milliseconds kPatience{10'000};
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!call({}, kOpenInterval)) {
    if (std::chrono::steady_clock::now() > end) throw Internal("no first reply within 10 s");
  }
  run_client({[&](const Content& content, const Seen& seen) {
    const auto reply = call(content, kPatience);
    if (!reply) throw Internal("no reply within 10 s");
    seen(*reply);
  }});
}

/// `server` serves while the function that it is given runs.
inline int raw_main(
    int argc, char** argv,
    const std::function<void(std::uint32_t domain, const std::function<void()>&)>& server,
    const std::function<void(std::uint32_t domain)>& client) {
  return run_peer([&] {
    if (argc != 3) throw InvalidArgument(std::string(argv[0]) + " server|client DOMAIN");
    const auto domain = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
    if (argv[1] == std::string("server")) {
      server(domain, run_server);
    } else {
      client(domain);
    }
  });
}

}  // namespace skein::benchmarks::raw
