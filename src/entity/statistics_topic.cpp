#include "skein/entity/statistics_topic.hpp"

#include <algorithm>
#include <mutex>
#include <tuple>

#include "skein/brokerless_discovery/admission.hpp"
#include "skein/core/error.hpp"
#include "skein/core/log.hpp"
#include "skein/core/sole_owner.hpp"
#include "skein/idl/codec.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::introspection {
namespace {

constexpr std::chrono::seconds kInterval{1};

const dds::Topic kTopic{"skein/statistics", "skein::introspection::ServiceStatistics", true};

dds::Qos qos() {
  dds::Qos qos;
  qos.reliable = false;
  qos.history_depth = 1;
  return qos;
}

}  // namespace

struct StatisticsTopic::State : std::enable_shared_from_this<State> {
  State(Clock& clock_, Executor& control_, Source source_)
      : clock(clock_), control(control_), source(std::move(source_)) {}

  Clock& clock;
  Executor& control;
  const Source source;
  std::mutex mutex;
  std::size_t readers = 0;
  bool ticking = false;
  TimerId timer = 0;
  std::shared_ptr<dds::Writer> writer;

  // On the vendor's thread.
  void on_reader(bool matched) {
    std::lock_guard lock(mutex);
    readers += matched ? 1 : -1;
    begin();
  }

  // Under the lock.
  void begin() {
    if (readers == 0 || ticking || !writer) return;
    ticking = true;
    post_tick();
  }

  void post_tick() {
    control.post([state = weak_from_this()] {
      if (const auto self = state.lock()) self->tick();
    });
  }

  void tick() {
    std::shared_ptr<dds::Writer> target;
    {
      std::lock_guard lock(mutex);
      ticking = readers > 0 && writer;
      if (!ticking) return;
      target = writer;
      timer = clock.call_after(kInterval, [state = weak_from_this()] {
        if (const auto self = state.lock()) self->post_tick();
      });
    }
    for (const ServiceStatistics& statistics : source()) write(*target, statistics);
  }

  static void write(dds::Writer& writer, const ServiceStatistics& statistics) {
    try {
      writer.write(idl::encode_message(statistics), key_hash(statistics));
    } catch (const Error& error) {
      log(LogLevel::Warning, statistics.service,
          std::string("statistics were not sent: ") + error.what());
    }
  }
};

StatisticsTopic::StatisticsTopic(dds::Participant& participant, Clock& clock, Executor& control,
                                 Source source)
    : state_(std::make_shared<State>(clock, control, std::move(source))) {
  dds::WriterListener listener;
  listener.on_matched = [state = std::weak_ptr(state_)](const Guid&, bool matched) {
    if (const auto self = state.lock()) self->on_reader(matched);
  };
  std::shared_ptr<dds::Writer> writer =
      participant.create_writer(kTopic, qos(), std::move(listener));
  std::lock_guard lock(state_->mutex);
  state_->writer = std::move(writer);
  state_->begin();
}

StatisticsTopic::~StatisticsTopic() {
  std::shared_ptr<dds::Writer> writer;  // goes outside the lock, which its listener takes
  TimerId timer;
  {
    std::lock_guard lock(state_->mutex);
    writer.swap(state_->writer);
    timer = state_->timer;
  }
  state_->clock.cancel(timer);
  await_sole_owner(state_);  // what is being asked may go when this returns
}

struct StatisticsReader::State {
  mutable std::mutex mutex;
  brokerless_discovery::Reports<ServiceStatistics> latest;
  std::uint64_t refused = 0;
  std::unique_ptr<dds::Reader> reader;  // last: goes first, and no listener runs after that

  void on_sample(const dds::Sample& sample) {
    std::lock_guard lock(mutex);
    std::string reason = "it is another participant's, or there is no room for more";
    if (take(sample, reason) || ++refused > 1) return;
    log(LogLevel::Warning, kTopic.name,
        "dropped statistics: " + reason + "; further ones are counted and not logged");
  }

  bool take(const dds::Sample& sample, std::string& reason) {
    if (sample.state != dds::InstanceState::Alive) return latest.erase(sample.key, sample.writer);
    try {
      auto statistics = idl::decode_message<ServiceStatistics>(sample.cdr);
      return sample.key.bytes == statistics.provider &&
             latest.put(sample.key, sample.writer, std::move(statistics), sample.cdr.size());
    } catch (const std::exception& error) {
      reason = error.what();
      return false;
    }
  }
};

StatisticsReader::StatisticsReader(dds::Participant& participant)
    : state_(std::make_unique<State>()) {
  dds::ReaderListener listener;
  listener.on_data = [&state = *state_](dds::Reader& reader) {
    reader.take([&state](const dds::Sample& sample) { state.on_sample(sample); });
  };
  listener.on_matched = [&state = *state_](const Guid& writer, bool matched) {
    std::lock_guard lock(state.mutex);
    if (!matched) state.latest.writer_gone(writer);
  };
  state_->reader = participant.create_reader(kTopic, qos(), std::move(listener));
}

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

std::uint64_t StatisticsReader::refused() const {
  std::lock_guard lock(state_->mutex);
  return state_->refused;
}

}  // namespace skein::introspection
