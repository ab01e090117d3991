#include "log.hpp"

#include <fastdds/dds/log/Log.hpp>

#include "core/log.hpp"

namespace skein::dds::fastdds {
namespace {

using eprosima::fastdds::dds::Log;

class Consumer final : public eprosima::fastdds::dds::LogConsumer {
 public:
  void Consume(const Log::Entry& entry) override {
    log(LogLevel::Error, "dds/fastdds", entry.message);
  }
};

}  // namespace

void route_log() {
  Log::ClearConsumers();
  Log::RegisterConsumer(std::make_unique<Consumer>());
  Log::SetVerbosity(Log::Error);  // it warns of every endpoint in another partition
}

}  // namespace skein::dds::fastdds
