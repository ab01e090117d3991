#include "domain_picture.hpp"

#include <algorithm>

#include "onlooker.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"

namespace skein::command {
namespace {

constexpr std::chrono::milliseconds kAnswersWithin{1000};

PeerPicture& of_participant(DomainPicture& picture, const Guid& participant,
                            const std::string& name) {
  const auto found = std::ranges::find(picture, participant, &PeerPicture::participant);
  if (found != picture.end()) return *found;
  picture.emplace_back();
  picture.back().participant = participant;
  picture.back().name = name;
  return picture.back();
}

}  // namespace

DomainPicture DomainLook::take(bool whole) {
  DomainPicture picture;
  for (auto& [participant, answer] :
       inspector_.ask_all(inspection::Subject::Self, kAnswersWithin)) {
    PeerPicture& peer = of_participant(picture, participant.participant(), answer.entity);
    if (!answer.peer.empty()) peer.process = answer.peer.front();
  }
  const auto& broker = entity_.broker();
  for (const auto& service : broker.all()) {
    const auto participant = broker.participant_of(Guid{service->provider});
    if (!participant || participant->participant() == entity_.guid().participant()) continue;
    const std::string name =
        service->owner.empty() ? service->system + "/" + service->entity : service->owner;
    of_participant(picture, participant->participant(), name).services.push_back(service);
  }
  if (whole) {
    for (auto& [participant, answer] :
         inspector_.ask_all(inspection::Subject::Topics, kAnswersWithin / 2))
      of_participant(picture, participant.participant(), answer.entity).topics = answer.topics;
    for (auto& [participant, answer] :
         inspector_.ask_all(inspection::Subject::Connections, kAnswersWithin / 2))
      of_participant(picture, participant.participant(), answer.entity).connections =
          answer.connections;
  }
  std::ranges::stable_sort(picture, {}, &PeerPicture::name);
  for (PeerPicture& peer : picture) {
    std::ranges::stable_sort(peer.services, {}, [](const auto& service) -> const std::string& {
      return service->service;
    });
  }
  return picture;
}

const PeerPicture* find_peer(const DomainPicture& picture, const Guid& participant) {
  const auto found = std::ranges::find(picture, participant, &PeerPicture::participant);
  return found == picture.end() ? nullptr : &*found;
}

bool is_tool(const PeerPicture& peer) {
  return peer.name.starts_with(std::string(Onlooker::kSystem) + "/skein-");
}

}  // namespace skein::command
