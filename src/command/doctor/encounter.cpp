#include "encounter.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <set>

#include "bench.idl.hpp"
#include "brokerless_discovery/broker.hpp"
#include "command/look/topic_survey.hpp"
#include "dds/port/vendor_names.hpp"
#include "service_versions.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace skein::command::doctor {
namespace {

class Mirror final : public skein_bench_service::Mirror {
  skein_bench_service::Octets reflect(const skein_bench_service::Octets& content) override {
    return content;
  }
};

struct Peer {
  std::string vendor;
  std::unique_ptr<Entity> entity;
};

Peer join_by(Onlooker place, const std::string& vendor) {
  place.vendor = vendor;
  Peer peer{vendor, std::make_unique<Entity>(place.entity_options("doctor-" + vendor))};
  peer.entity->provide<skein_bench_service::Mirror>(std::make_shared<Mirror>());
  return peer;
}

/// `system/entity` of all whose services that peer knows.
std::set<std::string> known_by(const Peer& peer) {
  std::set<std::string> names;
  for (const auto& service : peer.entity->broker().all())
    names.insert(service->system + "/" + (service->owner.empty() ? service->entity : ""));
  return names;
}

std::string name_of(const Peer& peer) {
  const auto& options = peer.entity->broker().options();
  return options.system + "/" + options.entity;
}

/// The pairs that have not found each other: who looks, and for whom.
std::vector<std::pair<const Peer*, const Peer*>> strangers(const std::vector<Peer>& peers) {
  std::vector<std::pair<const Peer*, const Peer*>> pairs;
  for (const Peer& looking : peers) {
    const auto known = known_by(looking);
    for (const Peer& other : peers)
      if (!known.contains(name_of(other))) pairs.emplace_back(&looking, &other);
  }
  return pairs;
}

/// Looks again and again until `condition` holds, `seconds` have passed or a signal came.
template <typename Condition>
void await(Condition condition, std::chrono::milliseconds time, const Interruption& interruption) {
  constexpr double kLookAgain = 0.05;
  const auto end = std::chrono::steady_clock::now() + time;
  while (!condition() && std::chrono::steady_clock::now() < end)
    if (interruption.wait(kLookAgain)) return;
}

Symptoms each_other(const std::vector<Peer>& peers, const Interruption& interruption) {
  await([&] { return strangers(peers).empty(); }, std::chrono::seconds(5), interruption);
  Symptoms symptoms;
  for (const auto& [looking, other] : strangers(peers)) {
    symptoms.push_back(
        {Severity::Error, "discovery",
         "a peer on " + looking->vendor + " does not find one on " + other->vendor +
             " on this host",
         "looked for 5 s in " + looking->entity->broker().options().place,
         "look at the other findings: interface, firewall and ports; then ask for help with the "
         "output of `skein doctor --json`"});
  }
  if (symptoms.empty()) {
    symptoms.push_back(
        {Severity::Fine, "discovery",
         "peers find each other in " + peers.front().entity->broker().options().place, "", ""});
  }
  return symptoms;
}

/// Those that another process could see: not those on the network inside of one process.
std::vector<const profile::PeerProfile*> visible_peers(const profile::MissionProfile& mission) {
  std::vector<const profile::PeerProfile*> peers;
  for (const profile::PeerProfile& peer : mission.peers)
    if (peer.vendor != dds::kLoopback) peers.push_back(&peer);
  return peers;
}

std::vector<const profile::PeerProfile*> absent_peers(const DomainPicture& picture,
                                                      const profile::MissionProfile& mission) {
  std::set<std::string> known;
  for (const PeerPicture& peer : picture) known.insert(peer.name);
  auto peers = visible_peers(mission);
  std::erase_if(peers,
                [&](const auto* peer) { return known.contains(peer->system + "/" + peer->name); });
  return peers;
}

Symptoms of_mission(const DomainPicture& picture, const profile::MissionProfile& mission,
                    bool flies, const std::string& place) {
  const auto absent = absent_peers(picture, mission);
  const std::size_t wanted = visible_peers(mission).size();
  if (absent.size() == wanted && flies) {
    return {{Severity::Warning, "peers", "no peer of the mission answers, though its launcher runs",
             "nothing of them is known in " + place,
             "see whether another finding tells that processes are stopped, and what `skein "
             "status` says"}};
  }
  if (absent.size() == wanted)
    return {
        {Severity::Note, "peers", "no peer of the mission answers: it does not fly now", "", ""}};
  Symptoms symptoms;
  for (const profile::PeerProfile* peer : absent) {
    symptoms.push_back(
        {Severity::Warning, "peers",
         "the peer '" + peer->name + "' does not answer, though others of the mission do",
         "nothing of " + peer->system + "/" + peer->name + " is known in " + place,
         "see whether another finding tells that its process is stopped, and what `skein status` "
         "says of it" +
             (peer->host.empty() ? "" : " on " + peer->host + ", and `skein doctor` there")});
  }
  if (symptoms.empty()) {
    symptoms.push_back({Severity::Fine, "peers",
                        "all " + std::to_string(wanted) + " peers of the mission answer", "", ""});
  }
  return symptoms;
}

/// Peers that answer to one name.
Symptoms namesakes_in(const DomainPicture& picture) {
  std::map<std::string, std::vector<std::string>> processes;
  for (const PeerPicture& peer : picture) {
    if (peer.process)
      processes[peer.name].push_back(std::to_string(peer.process->pid) + " on " +
                                     peer.process->host);
  }
  Symptoms symptoms;
  for (const auto& [name, all] : processes) {
    if (all.size() < 2) continue;
    std::string text;
    for (const std::string& process : all) text += (text.empty() ? "process " : ", ") + process;
    symptoms.push_back({Severity::Warning, "peers",
                        std::to_string(all.size()) + " peers are called " + name +
                            ": callers are served by any of them",
                        text, "end all but one, or give them other names or systems"});
  }
  return symptoms;
}

std::vector<KnownTopic::Endpoint> endpoints_of(const DomainPicture& picture) {
  std::vector<KnownTopic::Endpoint> endpoints;
  for (const PeerPicture& peer : picture) {
    for (const auto& topic : peer.topics) endpoints.push_back({peer.participant, peer.name, topic});
  }
  return endpoints;
}

}  // namespace

Symptoms encounter(const Onlooker& place, const std::vector<std::string>& vendors,
                   const profile::MissionProfile* mission, bool flies,
                   const Interruption& interruption) {
  if (vendors.empty()) return {};
  std::vector<Peer> peers;
  try {
    for (const std::string& vendor : vendors) peers.push_back(join_by(place, vendor));
  } catch (const Error& error) {
    return {{Severity::Error, "discovery", "a peer cannot join the domain", error.what(),
             "see the other findings"}};
  }
  Entity& looking = *peers.front().entity;
  DomainLook look(looking, interruption.gives_up());
  Symptoms symptoms = each_other(peers, interruption);
  DomainPicture picture;
  const auto complete = [&] {
    picture = look.take(false);
    std::erase_if(picture, is_tool);
    return mission && absent_peers(picture, *mission).empty();
  };
  await(complete, std::chrono::milliseconds(1500), interruption);
  picture = look.take(true);
  std::erase_if(picture, is_tool);
  const auto add = [&](const Symptoms& more) {
    symptoms.insert(symptoms.end(), more.begin(), more.end());
  };
  Inspector inspector(looking, interruption.gives_up());
  add(diagnose_peers(picture, types_told_by(inspector)));
  if (mission) add(of_mission(picture, *mission, flies, looking.broker().options().place));
  return symptoms;
}

Symptoms diagnose_peers(const DomainPicture& picture, const TellTypes& tell_types) {
  Symptoms symptoms = namesakes_in(picture);
  for (const PeerPicture& peer : picture) {
    if (!peer.process) {
      symptoms.push_back({Severity::Warning, "peers",
                          "the peer " + peer.name + " is known, and does not answer",
                          "its services stand in the Broker",
                          "see whether its process is stopped, or overloaded"});
    } else if (peer.process->version != SKEIN_VERSION) {
      symptoms.push_back({Severity::Warning, "versions",
                          "the peer " + peer.name + " runs Skein " + peer.process->version +
                              ", and this is " + SKEIN_VERSION,
                          "skein peers", "install the same version on all hosts of a mission"});
    } else if (peer.process->degraded) {
      symptoms.push_back({Severity::Warning, "peers",
                          "CSPs of the peer " + peer.name + " do not return", "skein peers",
                          "restart it; run such CSPs in processes of their own"});
    }
  }
  const auto endpoints = endpoints_of(picture);
  for (const std::string& conflict : topic_conflicts(endpoints, tell_types)) {
    symptoms.push_back({Severity::Warning, "topics", conflict, "skein topics",
                        "give both sides the same QoS profile and type, and end those that are "
                        "old"});
  }
  for (const std::string& conflict : service_conflicts(picture, tell_types)) {
    symptoms.push_back({Severity::Warning, "services", conflict, "skein services",
                        "build both from the same IDL, and end those that are old"});
  }
  for (const UnpublishedTopic& topic : unpublished_topics(endpoints)) {
    symptoms.push_back(
        {topic.misspelt ? Severity::Warning : Severity::Note, "topics", topic.sentence,
         "skein topics",
         topic.misspelt ? "correct the name where the code or the profile says it" : ""});
  }
  return symptoms;
}

}  // namespace skein::command::doctor
