#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace skein::benchmarks {

using Content = std::vector<std::uint8_t>;

/// The service of every configuration: application code, the same whatever carries the call.
inline Content echo(const Content& content) { return content; }

/// Is given the reply's octets where they lie, at the moment the caller can read them. The clock
/// stops here, so nobody pays for copying them into a type that his users would not use.
using Seen = std::function<void(std::span<const std::uint8_t>)>;

/// The client's view of the service: blocks until the reply has been seen, throws where there is
/// none.
using EchoCall = std::function<void(const Content&, const Seen&)>;

/// Sends a call without waiting; what it returns waits for the reply, and throws where there is
/// none. Replies are waited for in the order of the calls.
using StartEcho = std::function<std::function<void()>(const Content&)>;

/// How long a peer that starts with many others waits until it knows all of them.
inline constexpr std::chrono::seconds kJoinPatience{60};

/// What else a peer obeys, by its first word; gets the rest of the line, returns the answer.
using Command = std::function<std::string(const std::string& rest)>;
using Commands = std::vector<std::pair<std::string, Command>>;

struct Client {
  EchoCall call;
  /// Makes one more client, with a connection of its own; empty where this program has but one.
  std::function<EchoCall()> another{};
  /// Empty where there are no asynchronous calls: then each call in flight has a thread.
  StartEcho start{};
  Commands extra{};
};

/// A client's life after its first reply: says `ready` with the time, then obeys until its input
/// ends. A reply that is not the request's content ends it as failed.
///
/// | command | answer |
/// |---|---|
/// | `call SIZE COUNT` | `times`, COUNT of them: one call after the other |
/// | `paced SIZE COUNT INTERVAL` | `times`, each from when the call should have been sent (every
/// INTERVAL us) | | `crowd CLIENTS SIZE COUNT` | `times`, COUNT for each of so many clients that
/// call at once | | `pipelined SIZE COUNT DEPTH` | `times`, one: all calls' time by COUNT, with
/// DEPTH in flight | | `idle CLIENTS` | `idle`: has so many more connections from now on, over
/// which nothing goes |
///
/// Times are in ns. Every peer, server or client, also knows `place CORE` (-1: any; for all its
/// threads), `cpu` (processor time that it has used, in ns), `memory` and `resident` (octets, see
/// memory_octets()), `sleeps` (how often its threads have gone to sleep) and, where
/// harness/work_counter.cpp is preloaded, `counted WHAT`.
void run_client(const Client& client);

/// A server's: says `ready`, obeys until its input ends.
void run_server();

/// Any other peer's: says `ready` with the time, obeys `commands` and what every peer knows.
void run_commands(const Commands& commands);

/// Runs `peer` and turns what it throws into a last line: `skipped` for Skipped, `failed` for the
/// rest. The program's exit code.
int run_peer(const std::function<void()>& peer);

/// Of this process: `Rss:`, all that is resident, or `Pss:`, what it shares with others by its
/// share, so that a sum over processes counts it once. Throws Skipped where the system does not
/// tell.
std::uint64_t memory_octets(const std::string& kind);

/// Now in ns on the clock that all processes of a host share.
std::string now_text();

}  // namespace skein::benchmarks
