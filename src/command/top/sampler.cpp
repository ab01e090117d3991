#include "sampler.hpp"

#include <algorithm>

#include "command/print/figures.hpp"
#include "command/print/local_time.hpp"

namespace skein::command::top {
namespace {

constexpr double kSecond = 1e9;

std::string state_of(const PeerPicture& peer) {
  if (!peer.process) return "silent";
  return peer.process->degraded ? "degraded" : "ok";
}

}  // namespace

std::vector<PeerRow> Rates::peers(const DomainPicture& picture) {
  std::vector<PeerRow> rows;
  std::map<Guid, Used> now;
  for (const PeerPicture& peer : picture) {
    PeerRow row;
    row.name = peer.name;
    row.state = state_of(peer);
    row.services = peer.services.size();
    if (const auto& process = peer.process) {
      row.pid = process->pid;
      row.memory = process->memory;
      row.threads = process->threads;
      const Used used{process->time, process->cpu};
      const auto before = used_.find(peer.participant);
      if (before != used_.end() && used.time > before->second.time) {
        row.cpu = 100.0 * static_cast<double>(used.cpu - before->second.cpu) /
                  static_cast<double>(used.time - before->second.time);
      }
      now[peer.participant] = used;
    }
    rows.push_back(std::move(row));
  }
  used_ = std::move(now);
  return rows;
}

std::vector<ServiceRow> Rates::services(
    const std::vector<introspection::ServiceStatistics>& statistics, std::uint64_t now) {
  std::vector<ServiceRow> rows;
  std::map<Guid, Called> kept;
  for (const auto& service : statistics) {
    ServiceRow row;
    row.service = service.service;
    row.entity = service.system + "/" + service.entity;
    row.waiting = service.waiting;
    row.running = service.running;
    Called called{now, 0, 0, {}, {}};
    for (const auto& operation : service.operations) {
      called.received += operation.received;
      called.failed += operation.failed + operation.refused + operation.expired;
      if (operation.ran.p99 >= row.p99) {
        row.p50 = operation.ran.p50;
        row.p99 = operation.ran.p99;
      }
    }
    const Guid provider{service.provider};
    if (const auto before = called_.find(provider); before != called_.end()) {
      const Called& was = before->second;
      const double seconds = static_cast<double>(now - was.time) / kSecond;
      // Peers tell once a second: less than that says nothing new.
      if (seconds < 0.9) {
        called = was;
      } else {
        called.calls = static_cast<double>(called.received - was.received) / seconds;
        called.failures = static_cast<double>(called.failed - was.failed) / seconds;
      }
    }
    row.calls = called.calls;
    row.failed = called.failures;
    kept[provider] = called;
    rows.push_back(std::move(row));
  }
  called_ = std::move(kept);
  return rows;
}

std::string line_of(const introspection::Decision& decision) {
  std::string tried;
  for (const auto& attempt : decision.attempts) tried += (tried.empty() ? "" : ", ") + attempt.csp;
  return local_time(decision.time, "%H:%M:%S") + " " + decision.entity + " " + decision.request +
         ": " + (tried.empty() ? "nobody" : tried) + " " +
         (decision.failure.empty() ? "answered" : "failed") + " after " +
         short_time(static_cast<std::uint64_t>(std::max<std::int64_t>(decision.took, 0)));
}

}  // namespace skein::command::top
