#include "skein/loopback.hpp"

#include "entities.hpp"

namespace skein::dds {

using loopback::Topology;

LoopbackNetwork::LoopbackNetwork(Clock& clock) : hub_(std::make_shared<loopback::Hub>(clock)) {}
LoopbackNetwork::~LoopbackNetwork() = default;

std::shared_ptr<Vendor> LoopbackNetwork::vendor() { return loopback::make_vendor(hub_); }

void LoopbackNetwork::judge_transfers(std::function<Fate(const Transfer&)> judge) {
  hub_->judge_transfers(std::move(judge));
}

void LoopbackNetwork::isolate(const Guid& participant) {
  hub_->change(&Topology::isolate, participant);
}

void LoopbackNetwork::separate(const Guid& one, const Guid& other) {
  hub_->change(&Topology::separate, one, other);
}

void LoopbackNetwork::heal() { hub_->change(&Topology::heal); }

void LoopbackNetwork::pause(const Guid& participant) {
  hub_->change(&Topology::pause, participant, true);
}

void LoopbackNetwork::resume(const Guid& participant) {
  hub_->change(&Topology::pause, participant, false);
}

void LoopbackNetwork::kill(const Guid& participant) { hub_->change(&Topology::kill, participant); }

}  // namespace skein::dds
