#include "entity/statistics_topic.hpp"

#include <algorithm>
#include <mutex>
#include <tuple>
#include <utility>

#include "brokerless_discovery/admission.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::introspection {

struct StatisticsReader::State {
  explicit State(dds::Participant& participant)
      : reader(participant, kTopic<ServiceStatistics>,
               {[this](const dds::Sample& sample) { on_sample(sample); },
                [this](const Guid& writer) { on_writer_gone(writer); }}) {}

  void on_sample(const dds::Sample& sample) {
    const bool alive = sample.state == dds::InstanceState::Alive;
    if (!(alive ? put(sample) : erase(sample))) {
      throw InvalidArgument("it is of another participant's service, or there is no room for more");
    }
  }

  bool put(const dds::Sample& sample) {
    auto statistics = decoded<ServiceStatistics>(sample);
    std::lock_guard lock(mutex);
    return latest.put(sample.key, sample.writer, std::move(statistics), sample.cdr.size());
  }

  bool erase(const dds::Sample& sample) {
    std::lock_guard lock(mutex);
    return latest.erase(sample.key, sample.writer);
  }

  void on_writer_gone(const Guid& writer) {
    std::lock_guard lock(mutex);
    latest.writer_gone(writer);
  }

  std::mutex mutex;
  brokerless_discovery::Reports<ServiceStatistics> latest;
  AnyReader reader;  // last: goes first, and no listener runs after that
};

StatisticsReader::StatisticsReader(dds::Participant& participant)
    : state_(std::make_unique<State>(participant)) {}

StatisticsReader::~StatisticsReader() = default;

std::vector<ServiceStatistics> StatisticsReader::latest() const {
  std::vector<ServiceStatistics> all;
  {
    std::lock_guard lock(state_->mutex);
    state_->latest.for_each([&](const ServiceStatistics& one) { all.push_back(one); });
  }
  const auto place = [](const ServiceStatistics& statistics) {
    return std::tie(statistics.system, statistics.entity, statistics.service, statistics.provider);
  };
  std::sort(all.begin(), all.end(),
            [&](const auto& left, const auto& right) { return place(left) < place(right); });
  return all;
}

std::uint64_t StatisticsReader::refused() const { return state_->reader.refused(); }

}  // namespace skein::introspection
