#include "onlooker.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "command/mission/missions_elsewhere.hpp"
#include "core/printable.hpp"
#include "core/system/whole_file.hpp"
#include "dds/port/options_check.hpp"
#include "mission/peer/peer.hpp"
#include "mission/process/address_space.hpp"
#include "mission/process/exit_codes.hpp"
#include "mission/profile/mission_profile.hpp"
#include "mission/supervise/launch_plan.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestComplaint = 4096;

/// As a peer of this host speaks: one with an interface, where there is one.
dds::Network network_of(const profile::MissionProfile& mission, const std::string& host) {
  const profile::PeerProfile* chosen = nullptr;
  for (const profile::PeerProfile& peer : mission.peers) {
    if (!launch::is_here(peer.host, host)) continue;
    if (!chosen || (chosen->interface.empty() && !peer.interface.empty())) chosen = &peer;
  }
  if (!chosen) throw InvalidArgument(launch::nobody_here(mission, host));
  return launch::network_of(mission, *chosen);
}

std::uint32_t domain_of_environment() {
  const char* const text = std::getenv(kDomainVariable);
  if (!text || *text == '\0') return 0;
  std::uint32_t domain = 0;
  const char* const end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, domain);
  if (error == std::errc() && stop == end && domain <= dds::kMaxDomain) return domain;
  throw InvalidArgument(std::string(kDomainVariable) + " is '" + text +
                        "', which is no number from 0 to " + std::to_string(dds::kMaxDomain));
}

int fail(const Onlooker& onlooker, const Error& error, int code) {
  const std::uint32_t domain = onlooker.watched_domain();
  std::string text = error.what();
  const std::string place = "domain " + std::to_string(domain);
  if (text.find(place) == std::string::npos) text += "; it looked on " + place;
  const std::string elsewhere = missions_elsewhere(domain);
  if (!elsewhere.empty()) text += "; " + elsewhere;
  std::fprintf(stderr, "skein: %s\n", printable(text, kLongestComplaint).c_str());
  return code;
}

}  // namespace

std::uint32_t Onlooker::watched_domain() const {
  if (profile.empty()) return domain ? *domain : domain_of_environment();
  return static_cast<std::uint32_t>(
      profile::read_mission_profile(profile, profile::parse_variables(variables)).domain);
}

EntityOptions Onlooker::entity_options(const std::string& name) const {
  launch::demand_address_space();
  EntityOptions options;
  options.name = "skein-" + name + "-" + std::to_string(getpid());
  options.system = kSystem;
  options.vendor = dds::load_vendor(vendor);
  options.domain = watched_domain();
  if (!profile.empty()) {
    options.network = network_of(
        profile::read_mission_profile(profile, profile::parse_variables(variables)), host);
    return options;
  }
  if (!interface.empty()) options.network.interfaces = {interface};
  options.network.peers = peers;
  options.network.multicast_discovery = multicast;
  return options;
}

Entity join(const Onlooker& onlooker, const std::string& name) {
  auto options = onlooker.entity_options(name);
  try {
    return Entity(std::move(options));
  } catch (const Unavailable& error) {
    throw Internal(error.what());
  }
}

int look(const Onlooker& onlooker, const std::function<int()>& command) {
  try {
    return command();
  } catch (const WriteFailed&) {
    throw;
  } catch (const Unavailable& error) {
    if (!launch::address_space_limit().empty()) throw;  // which is told as the cause
    return fail(onlooker, error, launch::kNothingThere);
  } catch (const Disconnected& error) {
    return fail(onlooker, error, launch::kNothingThere);
  } catch (const TimedOut& error) {
    return fail(onlooker, error, launch::kNoAnswer);
  }
}

void tell_missions_elsewhere(const Onlooker& onlooker) {
  const std::string elsewhere = missions_elsewhere(onlooker.watched_domain());
  if (!elsewhere.empty()) std::fprintf(stderr, "skein: %s\n", elsewhere.c_str());
}

void tell_waiting(const Onlooker& onlooker, const char* what) {
  const std::uint32_t domain = onlooker.watched_domain();
  const std::string elsewhere = missions_elsewhere(domain);
  std::fprintf(stderr, "skein: waiting for %s on domain %u; Ctrl-C ends it%s%s\n", what, domain,
               elsewhere.empty() ? "" : "; ", elsewhere.c_str());
}

}  // namespace skein::command
