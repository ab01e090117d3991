#pragma once

#include <chrono>
#include <memory>

#include "call_port/call_port.hpp"
#include "skein/connector.hpp"

namespace skein::brokerless_discovery {
class Broker;
class LoadBoard;
}  // namespace skein::brokerless_discovery
namespace skein::rpc {
class CallJournal;
class LocalDirectory;
}  // namespace skein::rpc

namespace skein {

/// What a Connector works with, of its entity.
struct Connector::Parts {
  calls::ClientPort& dds;
  calls::ClientPort* same_host;  ///< Null: calls to processes of this host go over DDS, too.
  brokerless_discovery::Broker& broker;
  const brokerless_discovery::LoadBoard& loads;
  std::shared_ptr<rpc::LocalDirectory> directory;
  Executor& control;
  std::shared_ptr<Executor> continuations;
  std::shared_ptr<Clock> clock;
  std::chrono::microseconds spin;  ///< As EntityOptions::spin.
  std::shared_ptr<rpc::CallJournal> journal;
};

}  // namespace skein
