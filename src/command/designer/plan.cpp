#include "plan.hpp"

#include "mission/profile/mission_profile.hpp"

namespace skein::command::designer {
namespace {

void add_services(const profile::ComponentDescription* component, const std::string& csp,
                  const std::string& process, Plan::Entity& entity) {
  if (!component) return;  // of a program that says nothing of itself
  for (const auto& interface : component->interfaces)
    entity.services.push_back({interface.type, csp, process});
}

}  // namespace

Plan plan_of(const profile::MissionProfile& mission) {
  Plan plan{mission.file.string(), {}};
  for (const profile::PeerProfile& peer : mission.peers) {
    Plan::Entity entity{peer.system + "/" + peer.name, peer.system, peer.name, {}, {}};
    add_services(peer.component.get(), "", "", entity);
    for (const profile::CspProfile& csp : peer.csps) {
      const bool own = csp.process == profile::CspProcess::Own;
      add_services(csp.component.get(), csp.name, own ? peer.name + "/" + csp.name : "", entity);
    }
    if (peer.component)
      for (const auto& dependency : peer.component->dependencies)
        entity.dependencies.push_back(dependency.type);
    plan.entities.push_back(std::move(entity));
  }
  return plan;
}

}  // namespace skein::command::designer
