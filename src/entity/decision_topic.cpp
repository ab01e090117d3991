#include "skein/entity/decision_topic.hpp"

#include <atomic>
#include <mutex>
#include <utility>

#include "skein/core/error.hpp"
#include "skein/core/log.hpp"
#include "skein/idl/codec.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::introspection {
namespace {

const dds::Topic kTopic{"skein/decisions", "skein::introspection::Decision", false};

dds::Qos qos() {
  dds::Qos qos;
  qos.reliable = false;
  qos.history_depth = 64;
  return qos;
}

}  // namespace

struct DecisionTopic::State {
  explicit State(Executor& control_) : control(control_) {}

  Executor& control;
  std::atomic<int> readers{0};
  std::mutex mutex;
  std::shared_ptr<dds::Writer> writer;

  void write(const Decision& decision) {
    std::shared_ptr<dds::Writer> target;
    {
      std::lock_guard lock(mutex);
      target = writer;
    }
    if (!target) return;
    try {
      target->write(idl::encode_message(decision));
    } catch (const Error& error) {
      log(LogLevel::Warning, kTopic.name, std::string("a decision was not sent: ") + error.what());
    }
  }
};

DecisionTopic::DecisionTopic(dds::Participant& participant, Executor& control)
    : state_(std::make_shared<State>(control)) {
  dds::WriterListener listener;
  listener.on_matched = [state = std::weak_ptr(state_)](const Guid&, bool matched) {
    if (const auto self = state.lock()) self->readers += matched ? 1 : -1;
  };
  std::shared_ptr<dds::Writer> writer =
      participant.create_writer(kTopic, qos(), std::move(listener));
  std::lock_guard lock(state_->mutex);
  state_->writer = std::move(writer);
}

DecisionTopic::~DecisionTopic() {
  std::shared_ptr<dds::Writer> writer;  // goes after the lock is released
  std::lock_guard lock(state_->mutex);
  writer.swap(state_->writer);
}

bool DecisionTopic::on() const noexcept { return state_->readers > 0; }

void DecisionTopic::tell(const DecisionRecord& record) {
  if (!on()) return;
  state_->control.post([state = std::weak_ptr(state_), decision = report_of(record)] {
    if (const auto self = state.lock()) self->write(decision);
  });
}

DecisionReader::DecisionReader(dds::Participant& participant,
                               std::function<void(const Decision&)> consumer) {
  dds::ReaderListener listener;
  listener.on_data = [consumer = std::move(consumer),
                      malformed = false](dds::Reader& reader) mutable {
    reader.take([&](const dds::Sample& sample) {
      if (sample.state != dds::InstanceState::Alive) return;
      Decision decision;
      try {
        decision = idl::decode_message<Decision>(sample.cdr);
      } catch (const std::exception& error) {
        if (std::exchange(malformed, true)) return;
        log(LogLevel::Warning, kTopic.name,
            std::string("dropped a malformed sample: ") + error.what() +
                "; further ones are not logged");
        return;
      }
      consumer(decision);
    });
  };
  reader_ = participant.create_reader(kTopic, qos(), std::move(listener));
}

}  // namespace skein::introspection
