#include "brokerless_discovery/load_board.hpp"

#include <atomic>
#include <map>
#include <mutex>

#include "brokerless_discovery/admission.hpp"
#include "core/log.hpp"
#include "core/threads/sole_owner.hpp"
#include "skein/detail/codec.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {
namespace {

using discovery::ServiceLoad;

const dds::Topic kTopic{"skein/loads", "skein::discovery::ServiceLoad", true};

dds::Qos load_qos() {
  dds::Qos qos;
  qos.transient_local = true;
  qos.history_depth = 1;
  return qos;
}

}  // namespace

struct LoadBoard::State : std::enable_shared_from_this<State> {
  struct Own {
    std::function<std::size_t()> measure;
    std::size_t told = 0;
  };
  State(dds::Participant& participant_, Clock& clock_, Executor& control_)
      : participant(participant_), clock(clock_), control(control_) {}

  dds::Participant& participant;
  Clock& clock;
  Executor& control;

  mutable std::mutex mutex;
  Reports<std::size_t> loads;
  std::uint64_t refused = 0;

  std::mutex telling;  // guards what follows; never taken by a listener
  std::map<Guid, Own> own;
  std::unique_ptr<dds::Writer> writer;  // made when there is something to tell
  std::unique_ptr<dds::Reader> reader;
  bool closed = false;

  std::atomic<bool> awake{false};  // a timer will have the loads measured
  std::atomic<TimerId> timer{0};

  // ---- what others tell

  void open() {
    dds::ReaderListener listener;
    listener.on_data = [this](dds::Reader& source) {
      source.take([this](const dds::Sample& sample) { on_sample(sample); });
    };
    listener.on_matched = [this](const Guid& gone, bool matched) {
      std::lock_guard lock(mutex);
      if (!matched) loads.writer_gone(gone);
    };
    std::lock_guard lock(telling);
    reader = participant.create_reader(kTopic, load_qos(), std::move(listener));
  }

  void on_sample(const dds::Sample& sample) {
    std::lock_guard lock(mutex);
    if (!take(sample)) ++refused;
  }

  // Of whom nothing is believed is taken for idle.
  bool take(const dds::Sample& sample) {
    if (sample.state == dds::InstanceState::Disposed) {
      return loads.erase(sample.key, sample.writer);
    }
    try {
      const auto load = idl::decode_message<ServiceLoad>(sample.cdr);
      return sample.key.bytes == load.provider &&
             loads.put(sample.key, sample.writer, load.requests, sizeof load);
    } catch (const std::exception&) {
      return false;
    }
  }

  // ---- what this peer tells

  // A load changes, and tick() measures it, under the lock of what is counted. So if tick()
  // measures before the change, this sees that it is awake no more, though the load is relaxed.
  void wake() {
    if (awake.load(std::memory_order_relaxed) || awake.exchange(true)) return;
    timer = clock.call_after(kInterval, [state = weak_from_this()] {
      const auto self = state.lock();
      if (!self) return;
      const bool posted = self->control.post([state] {
        if (const auto self = state.lock()) self->tick();
      });
      if (!posted) self->awake = false;  // the next change tries again
    });
  }

  void tick() {
    awake = false;  // what changes from now on is measured anew
    std::lock_guard lock(telling);
    if (closed) return;
    for (auto& [provider, mine] : own) {
      const std::size_t load = mine.measure();
      if (load == mine.told) continue;
      mine.told = load;
      write(provider, load);
    }
  }

  void write(const Guid& provider, std::size_t load) {
    const ServiceLoad sample{provider.bytes, static_cast<std::uint32_t>(load)};
    try {
      if (!writer) writer = participant.create_writer(kTopic, load_qos());
      writer->write(idl::encode_message(sample), provider);
    } catch (const Error& error) {
      log(LogLevel::Warning, "broker", std::string("a load was not told: ") + error.what());
    }
  }

  void withdraw(const Guid& provider) {
    std::lock_guard lock(telling);
    if (own.erase(provider) == 0 || !writer) return;
    try {
      writer->dispose(provider);
    } catch (const Error& error) {
      log(LogLevel::Warning, "broker", std::string("a load was not withdrawn: ") + error.what());
    }
  }
};

LoadBoard::LoadBoard(dds::Participant& participant, Clock& clock, Executor& control)
    : state_(std::make_shared<State>(participant, clock, control)) {
  state_->open();
}

LoadBoard::~LoadBoard() {
  std::unique_ptr<dds::Reader> reader;
  std::unique_ptr<dds::Writer> writer;
  {
    std::lock_guard lock(state_->telling);
    state_->closed = true;
    reader.swap(state_->reader);
    writer.swap(state_->writer);
  }
  state_->clock.cancel(state_->timer);
  await_sole_owner(state_);
}

Broker::Registration LoadBoard::tell(const Guid& provider, std::function<std::size_t()> measure) {
  {
    std::lock_guard lock(state_->telling);
    state_->own[provider].measure = std::move(measure);
  }
  state_->wake();
  return Broker::Registration([state = std::weak_ptr(state_), provider] {
    if (const auto self = state.lock()) self->withdraw(provider);
  });
}

std::function<void()> LoadBoard::notifier() const {
  return [state = std::weak_ptr(state_)] {
    if (const auto self = state.lock()) self->wake();
  };
}

std::size_t LoadBoard::load_of(const Guid& provider) const {
  std::lock_guard lock(state_->mutex);
  const std::size_t* const load = state_->loads.find(provider);
  return load ? *load : 0;
}

std::uint64_t LoadBoard::refused() const {
  std::lock_guard lock(state_->mutex);
  return state_->refused;
}

}  // namespace skein::brokerless_discovery
