#include "skein/process.hpp"

#include "brokerless_discovery/process_watch.hpp"
#include "rpc/service/local_directory.hpp"

namespace skein {

Process::Process() : Process(std::make_shared<SystemClock>()) {}

Process::Process(std::shared_ptr<Clock> clock)
    : clock_(std::move(clock)),
      watch_(std::make_unique<brokerless_discovery::ProcessWatch>()),
      directory_(std::make_shared<rpc::LocalDirectory>()) {}

Process::~Process() = default;

}  // namespace skein
