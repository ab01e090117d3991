#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace skein::benchmarks {

using Content = std::vector<std::uint8_t>;

/// The service of every configuration: application code, the same whatever carries the call.
inline Content echo(const Content& content) { return content; }

/// The client's view of it: blocks until the reply is here, throws where there is none.
using EchoCall = std::function<Content(const Content&)>;

/// What else a client obeys, by its first word; gets the rest of the line, returns the answer.
using Command = std::function<std::string(const std::string& rest)>;

/// A client's life after its first reply: says `ready` with the time, then obeys `call SIZE COUNT`,
/// answered by that many times in ns, and `extra`'s commands, until its input ends. A reply that is
/// not the request's content ends it as failed.
void run_client(const EchoCall& call, const std::vector<std::pair<std::string, Command>>& extra = {});

/// A server's: says `ready`, waits until its input ends.
void run_server();

/// Runs `peer` and turns what it throws into a last line: `skipped` for Skipped, `failed` for the rest.
/// The program's exit code.
int run_peer(const std::function<void()>& peer);

/// Now in ns on the clock that all processes of a host share.
std::string now_text();

}  // namespace skein::benchmarks
