#include "self_report.hpp"

#include <errno.h>  // program_invocation_short_name
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>

#include "core/log.hpp"
#include "core/system/host.hpp"
#include "core/wall_clock.hpp"

namespace skein::introspection {
namespace {

std::uint64_t nanoseconds(std::chrono::nanoseconds time) {
  return static_cast<std::uint64_t>(time.count());
}

std::uint64_t processor_time() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto of = [](const timeval& time) {
    return std::chrono::seconds(time.tv_sec) + std::chrono::microseconds(time.tv_usec);
  };
  return nanoseconds(of(used.ru_utime) + of(used.ru_stime));
}

std::uint64_t memory() {
  std::uint64_t whole = 0;
  std::uint64_t resident = 0;
  std::ifstream("/proc/self/statm") >> whole >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint32_t threads() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("Threads:")) return static_cast<std::uint32_t>(std::stoul(line.substr(8)));
  }
  return 0;
}

/// Since 1970: now, less the time since it began (proc(5), field 22 of stat, in ticks since boot).
std::uint64_t started() {
  std::string text;
  std::getline(std::ifstream("/proc/self/stat"), text);
  std::size_t at = text.rfind(')');
  for (int field = 2; field < 22 && at != std::string::npos; ++field) at = text.find(' ', at + 1);
  double uptime = 0;
  std::ifstream("/proc/uptime") >> uptime;
  if (at == std::string::npos || uptime == 0) return 0;
  const double begin = std::stod(text.substr(at + 1)) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  return nanoseconds_since_1970() - static_cast<std::uint64_t>((uptime - begin) * 1e9);
}

std::vector<std::uint64_t> optional_time(const std::optional<std::chrono::milliseconds>& time) {
  if (!time) return {};
  return {nanoseconds(*time)};
}

}  // namespace

inspection::Peer report_of_this_process() {
  static const std::uint64_t begin = started();
  inspection::Peer peer;
  peer.host = name_of_this_host();
  peer.pid = static_cast<std::uint32_t>(::getpid());
  peer.program = program_invocation_short_name;
  peer.version = SKEIN_VERSION;
  peer.started = begin;
  peer.time = nanoseconds_since_1970();
  peer.cpu = processor_time();
  peer.memory = memory();
  peer.threads = threads();
  return peer;
}

inspection::TopicEndpoint report_of(const topics::Endpoint& endpoint) {
  const TypeSupport& type = *endpoint.type.support;
  inspection::TopicEndpoint report;
  report.name = endpoint.name;
  report.type = type.name;
  report.systems = endpoint.qos.systems;
  report.publishes = endpoint.publishes;
  report.keyed = endpoint.type.key_of != nullptr;
  report.xcdr2 = is_xcdr2(type.representation);
  report.reliable = endpoint.qos.reliable;
  report.transient_local = endpoint.qos.transient_local;
  report.exclusive = endpoint.qos.exclusive;
  report.deadline = optional_time(endpoint.qos.deadline);
  report.lifespan = optional_time(endpoint.qos.lifespan);
  report.lease = optional_time(endpoint.qos.liveliness_lease);
  report.signature = type.description.signature;
  report.matched = static_cast<std::uint32_t>(endpoint.matched);
  report.samples = endpoint.samples;
  report.dropped = endpoint.dropped;
  report.missed_deadlines = endpoint.missed_deadlines;
  return report;
}

inspection::Connection report_of(const ConnectionInfo& connection) {
  return {connection.service,
          connection.provider.bytes,
          connection.transport,
          connection.not_faster,
          static_cast<std::uint32_t>(connection.pending),
          connection.calls};
}

std::vector<LogLine> LogReport::operator()(bool anew) {
  if (anew) {
    told_ = 0;
    return {};  // the new reader may not have heard of this writer yet: it has until the next time
  }
  std::vector<LogLine> lines;
  for (LoggedLine& line : logged_after(told_)) {
    told_ = line.number;
    lines.push_back({entity_, name_of_this_host(), static_cast<std::uint32_t>(::getpid()),
                     line.number, static_cast<Severity>(line.level), std::move(line.place),
                     std::move(line.text), line.time});
  }
  return lines;
}

}  // namespace skein::introspection
