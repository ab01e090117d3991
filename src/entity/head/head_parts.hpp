#pragma once

#include <memory>
#include <string>

#include "skein/head.hpp"

namespace skein::brokerless_discovery {
class Broker;
}
namespace skein::rpc {
class LocalDirectory;
}

namespace skein {

/// What a Head works with, of its entity; all of it outlives the Head.
struct Head::Parts {
  Connector& connector;
  brokerless_discovery::Broker& broker;
  std::shared_ptr<rpc::LocalDirectory> directory;
  Clock& clock;
  dds::Participant& participant;
  Executor& control;
  std::string entity;  ///< `system/name`
};

}  // namespace skein
