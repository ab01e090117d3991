#pragma once

#include <chrono>
#include <vector>

#include "calls/configuration.hpp"
#include "harness/comparison.hpp"

/// What a call costs, beside the raw vendors and beside other middleware, how long the first one
/// takes, and how soon a caller knows that its provider is dead.
namespace skein::benchmarks {

struct CallPlan {
  struct Size {
    std::size_t size_bytes;
    std::size_t calls_per_turn;
  };
  std::vector<Size> sizes;
  std::size_t rounds;
};

/// What is measured beside other middleware; small calls carry 64 octets.
struct RivalPlan {
  std::vector<CallPlan::Size> sizes;
  std::size_t rounds;
  std::size_t paced_calls;
  std::size_t crowd_calls;  ///< Of each client.
  std::size_t pipelined_calls;
  std::size_t cpu_calls;
  std::size_t in_process_calls;
};

/// Calls through Skein, raw calls and a Unix socket, all processes alive and taking turns.
/// One comparison for each pair of vendors, size and rival.
std::vector<Comparison> compare_calls(Configurations& configurations, const CallPlan& plan);

/// Skein beside what the vendors can do by shared memory, data sharing, replies from a listener,
/// and polling: what Skein's transport and threads cost.
std::vector<Comparison> compare_ways(Configurations& configurations, const CallPlan& plan);

/// Skein beside omniORB, gRPC and ZeroMQ: one after the other, at a fixed rate, with several
/// clients, with many calls in flight, and the processor time of both sides.
std::vector<Comparison> compare_rivals(Configurations& configurations, const RivalPlan& plan);

/// A call between processes of one host through shared memory, its service on a thread of its own,
/// on the one that takes the request, and with all threads that wait spinning; beside one over DDS,
/// omniORB, a Unix socket, and memory on which both sides spin.
std::vector<Comparison> compare_same_host(Configurations& configurations, const CallPlan& plan);

struct LoanPlan {
  std::size_t calls_per_turn;
  std::size_t rounds;
};

/// A call that lends a mebibyte, beside a copy of one, and a call that lends 64 of them; the
/// service on the thread that takes the request.
std::vector<Comparison> compare_loans(Configurations& configurations, const LoanPlan& plan);

/// A call that does not leave its process, beside omniORB's.
std::vector<Comparison> compare_in_process(Configurations& configurations, const RivalPlan& plan);

struct IdleClientsPlan {
  CallPlan calls;
  std::size_t many;  ///< Connections through shared memory.
};

/// A call while 32 other clients of the same service do nothing, and through shared memory while
/// many do, beside one without them; and what memory these take.
std::vector<Comparison> compare_idle_clients(Configurations& configurations,
                                             const IdleClientsPlan& plan);

/// What a Head and its dispatch add to the call of a CSP that lives in its process.
struct HeadPlan {
  std::size_t tasks;
  std::size_t rounds;
};
std::vector<Comparison> compare_head(Configurations& configurations, const HeadPlan& plan);

struct FindPlan {
  std::size_t searches;
  std::size_t rounds;
};

/// Looking one service up among 10 to 10,000, beside omniORB's name server.
std::vector<Comparison> compare_find_service(Configurations& configurations, const FindPlan& plan);

/// Fresh pairs of processes; the provider is up, the client's process begins.
std::vector<Comparison> compare_cold_starts(Configurations& configurations, std::size_t starts);

/// Peers that start at once, a process each, until all see all, beside raw peers with the same
/// endpoints.
struct JoinPlan {
  std::size_t peers;
  std::size_t rounds;
};
std::vector<Comparison> compare_joins(Configurations& configurations, const JoinPlan& plan);

/// What peers that see all others and do nothing cost, each: octets and packets on the wire,
/// processor time; beside raw peers with the same endpoints, and beside participants without any
/// endpoint: what is more than that is for the registry. So many windows of time for each count.
struct IdlePlan {
  std::vector<std::size_t> peers;
  std::size_t windows;
  std::chrono::milliseconds window;
};
std::vector<Comparison> compare_idle_peers(Configurations& configurations, const IdlePlan& plan);

/// SIGKILL to a provider with a call pending: until the caller has Disconnected, and until the
/// description has gone.
std::vector<Comparison> compare_deaths_on_one_host(Configurations& configurations,
                                                   std::size_t kills);
std::vector<Comparison> compare_deaths_across_hosts(Configurations& configurations,
                                                    std::size_t kills);

/// Providers that are stopped beyond their lease, killed and started anew, and a network that is
/// cut: how late calls end that nobody answers, and how soon after the fault calls are answered and
/// both peers know each other's service again.
struct FaultPlan {
  std::size_t stops;
  std::size_t calls;  ///< Unanswered ones, each time.
  std::size_t cuts;
  std::chrono::milliseconds cut;
};
std::vector<Comparison> compare_faults_on_one_host(Configurations& configurations,
                                                   const FaultPlan& plan);
std::vector<Comparison> compare_faults_across_hosts(Configurations& configurations,
                                                    const FaultPlan& plan);

}  // namespace skein::benchmarks
