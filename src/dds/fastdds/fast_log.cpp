#include "fast_log.hpp"

#include <fastdds/dds/log/Log.hpp>

#include "core/log.hpp"
#include "dds/rtps/repeated_messages.hpp"

namespace skein::dds::fastdds {
namespace {

using eprosima::fastdds::dds::Log;

class Consumer final : public eprosima::fastdds::dds::LogConsumer {
 public:
  void Consume(const Log::Entry& entry) override {
    if (const auto message = repeated_.next(entry.message))
      log(LogLevel::Error, "dds/fastdds", *message);
  }

 private:
  RepeatedMessages repeated_;
};

}  // namespace

void route_log() {
  Log::ClearConsumers();
  Log::RegisterConsumer(std::make_unique<Consumer>());
  Log::SetVerbosity(Log::Error);  // it warns of every endpoint in another partition
}

}  // namespace skein::dds::fastdds
