#pragma once

#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "test/connector/pairing.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/eventually.hpp"

namespace skein::test {

/// Lets a fault last: its length is a test's input, not a wait for what comes of it.
inline void let_last(std::chrono::milliseconds length) { std::this_thread::sleep_for(length); }

/// How near to its end a call may be taken for one that still has time: its provider estimates how
/// long the request was under way, and a loaded machine blurs that.
inline constexpr std::chrono::milliseconds kNear{200};

/// The peer program (peer.cpp) as `name` on that vendor. `more` are further arguments of it.
inline ChildProcess start_peer(const std::string& name, const dds::Vendor& vendor,
                               const std::vector<std::string>& more = {},
                               ChildProcess::Options options = {}) {
  options.arguments = {"vendor=" + vendor.name(), "name=" + name};
  options.arguments.insert(options.arguments.end(), more.begin(), more.end());
  return ChildProcess("faults_peer", options);
}

/// The same, once it provides the echo service.
inline ChildProcess start_provider(const std::string& name, const dds::Vendor& vendor,
                                   const std::vector<std::string>& more = {},
                                   ChildProcess::Options options = {}) {
  auto peer = start_peer(name, vendor, more, std::move(options));
  peer.send("provide");
  peer.expect("provided");
  return peer;
}

/// The same, once it is connected to a provider.
inline ChildProcess start_client(const std::string& name, const dds::Vendor& vendor,
                                 const std::vector<std::string>& more = {},
                                 ChildProcess::Options options = {}) {
  auto peer = start_peer(name, vendor, more, std::move(options));
  peer.send("connect");
  peer.expect("connected", std::chrono::seconds(30));
  return peer;
}

/// How many providers of the echo service a peer program knows now.
inline int services_of(ChildProcess& peer) {
  peer.send("services");
  return std::stoi(peer.expect("services"));
}

/// Lets a peer program call until it is answered. A peer that was cut off does not know it at
/// first: its first calls may end as Disconnected, and as Unavailable while it has not found the
/// provider again; each at once, not by its deadline.
inline void call_until_connected(ChildProcess& peer) {
  std::string answer;
  eventually([&] {
    answer = peer.ask("echo 1 hello", std::chrono::seconds(30));
    return !answer.starts_with("error Disconnected") && !answer.starts_with("error Unavailable");
  });
  if (!answer.starts_with("echoed")) throw std::runtime_error("a call ended with '" + answer + "'");
}

/// The entity of a test's own process, with a lease.
inline std::unique_ptr<Entity> entity_with_lease(const std::string& name,
                                                 std::shared_ptr<dds::Vendor> vendor,
                                                 std::chrono::milliseconds lease) {
  EntityOptions options;
  options.name = name;
  options.system = "uav-1";
  options.vendor = std::move(vendor);
  options.domain = 17;
  options.lease = lease;
  options.shared_memory_calls = std::getenv("SKEIN_SHARED_MEMORY_CALLS") != nullptr;
  return std::make_unique<Entity>(std::move(options));
}

}  // namespace skein::test
