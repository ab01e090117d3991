#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "core/log.hpp"
#include "dds/port/port.hpp"
#include "register.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/detail/malformed_sample.hpp"
#include "skein/error.hpp"
#include "skein/topics.hpp"
#include "wire_topic.hpp"

namespace skein::topics {
namespace {

/// So many values are handed over before other subscriptions on the executor have their turn.
constexpr std::size_t kTurn = 32;

using Clock = std::chrono::steady_clock;

/// A callback that takes so long holds up all others of its executor.
constexpr std::chrono::seconds kTooLong{1};

}  // namespace

/// Samples wait in the port's reader, which bounds them and drops what has expired, until the
/// executor has a turn for them.
struct TopicReader::State : std::enable_shared_from_this<State> {
  State(Executor& executor_, std::string name_, const TopicType& type_, Consumer consumer_,
        SubscriptionOptions options_)
      : executor(options_.executor != nullptr ? *options_.executor : executor_),
        name(std::move(name_)),
        type(type_),
        consumer(std::move(consumer_)),
        options(std::move(options_)),
        value(type.support->make(), type.support->destroy) {}

  dds::ReaderListener listener();
  /// What a callback throws is reported, the first time, and harms nobody; under `running`.
  template <class Call>
  void guarded(const Call& call);
  void report_thrown(const std::string& what);
  /// Tells, the first time, of a callback that does not return.
  void tell_if_stuck();
  std::optional<Guid> find_key(std::span<const std::byte> cdr) const;
  /// Runs `tell` on the executor, unless the subscription has gone by then.
  void post(std::function<void(State&)> tell);
  void schedule();
  void hand_over();
  void hand_over(const dds::Sample& sample);
  /// False for what is no value: disposals and malformed samples, which it deals with.
  bool decode(const dds::Sample& sample, void* into);
  void report_malformed(const std::string& reason);
  SubscriptionCounters counters() const;
  /// Waits for the callback that another thread runs, and says so when that takes long.
  void await_callback();
  bool runs_here() const { return runner.load() == std::this_thread::get_id(); }

  Executor& executor;
  const std::string name;
  const TopicType type;
  const Consumer consumer;
  const SubscriptionOptions options;
  const std::unique_ptr<void, void (*)(void*) noexcept> value;  // the callback's; under running
  std::atomic<Clock::time_point> began{};  // the callback that runs; nothing while none does
  std::atomic<bool> told_stuck{false};
  std::atomic<bool> scheduled{false};
  std::atomic<std::uint64_t> received{0};
  std::atomic<std::uint64_t> malformed{0};
  std::atomic<std::uint64_t> missed_deadlines{0};
  std::mutex running;                     // one callback at a time
  std::atomic<std::thread::id> runner{};  // whose thread has it
  std::atomic<bool> ending{false};        // no further callback begins; one may run
  std::mutex ending_mutex;
  std::condition_variable returned;
  bool closed = false;  // under running
  bool threw = false;   // under running
  std::unique_ptr<dds::Reader> reader;
  std::optional<Register::Entry> entry;  // until it is closed
};

TopicReader::TopicReader(dds::Participant& participant, Executor& executor, const std::string& name,
                         const TopicType& type, const TopicQos& qos, Consumer consumer,
                         SubscriptionOptions options, Register* known)
    : state_(
          std::make_shared<State>(executor, name, type, std::move(consumer), std::move(options))) {
  auto reader =
      participant.create_reader(wire_topic(name, type), wire_qos(qos, type), state_->listener());
  {
    std::lock_guard lock(state_->running);
    state_->reader = std::move(reader);
  }
  state_->entry.emplace(known, [state = state_.get(), qos] {
    const SubscriptionCounters counters = state->counters();
    return Endpoint{.name = state->name,
                    .type = state->type,
                    .qos = qos,
                    .matched = state->reader->matched_writers().size(),
                    .samples = counters.received,
                    .dropped = counters.dropped + counters.expired + counters.malformed,
                    .missed_deadlines = counters.missed_deadlines};
  });
  // What came before the reader was known here was not told to anybody.
  state_->schedule();
}

TopicReader::~TopicReader() {
  state_->entry.reset();
  if (state_->runs_here()) {
    log(LogLevel::Error, "topics",
        "topic '" + state_->name +
            "': a callback destroys its own subscription, which ends when the callback returns; "
            "destroy it elsewhere");
    state_->closed = true;
    return;
  }
  std::unique_ptr<dds::Reader> reader;
  state_->await_callback();
  {
    std::lock_guard lock(state_->running);
    state_->closed = true;
    reader = std::move(state_->reader);
  }
}

void TopicReader::State::await_callback() {
  ending = true;
  std::unique_lock lock(ending_mutex);
  const auto idle = [this] { return runner.load() == std::thread::id(); };
  if (returned.wait_for(lock, kTooLong, idle)) return;
  log(LogLevel::Warning, "topics",
      "topic '" + name +
          "': whoever ends its subscription waits for a callback that does not return; let it "
          "return");
}

dds::ReaderListener TopicReader::State::listener() {
  dds::ReaderListener listener;
  const std::weak_ptr<State> weak = weak_from_this();
  listener.on_data = [weak](dds::Reader&) {
    const auto state = weak.lock();
    if (!state) return;
    state->tell_if_stuck();
    state->schedule();
  };
  if (type.key_of != nullptr) {
    listener.find_key = [weak](std::span<const std::byte> cdr) -> std::optional<Guid> {
      const auto state = weak.lock();
      return state ? state->find_key(cdr) : std::nullopt;
    };
  }
  listener.on_deadline_missed = [weak](const Guid& key) {
    const auto state = weak.lock();
    if (!state) return;
    ++state->missed_deadlines;
    if (!state->options.on_deadline_missed) return;
    state->post([key](State& self) { self.options.on_deadline_missed(key); });
  };
  listener.on_incompatible = [](const dds::Incompatibility& why) {
    log(LogLevel::Warning, "topics", why.explanation);
  };
  return listener;
}

template <class Call>
void TopicReader::State::guarded(const Call& call) {
  try {
    call();
  } catch (const std::exception& error) {
    report_thrown(error.what());
  } catch (...) {
    report_thrown("something that is no std::exception");
  }
}

void TopicReader::State::report_thrown(const std::string& what) {
  if (std::exchange(threw, true)) return;
  log(LogLevel::Error, "topics",
      "topic '" + name + "': a callback threw: " + what +
          "; what this subscription's callbacks throw from now on is not logged");
}

std::optional<Guid> TopicReader::State::find_key(std::span<const std::byte> cdr) const {
  const std::unique_ptr<void, void (*)(void*) noexcept> decoded(type.support->make(),
                                                                type.support->destroy);
  try {
    type.support->decode(decoded.get(), cdr, idl::kEncapsulation.size());
  } catch (const idl::MalformedSample&) {
    return std::nullopt;
  }
  return type.key_of(decoded.get());
}

void TopicReader::State::post(std::function<void(State&)> tell) {
  const bool posted = executor.post([weak = weak_from_this(), tell = std::move(tell)] {
    const auto state = weak.lock();
    if (!state) return;
    std::unique_ptr<dds::Reader> ended;  // goes without the lock
    std::lock_guard lock(state->running);
    if (state->closed) return;
    state->runner = std::this_thread::get_id();
    if (!state->ending) state->guarded([&] { tell(*state); });
    state->runner = std::thread::id();
    if (state->ending) {
      const std::lock_guard ending(state->ending_mutex);
      state->returned.notify_all();
    }
    if (state->closed) ended = std::move(state->reader);
  });
  if (!posted) {
    scheduled = false;
    log(LogLevel::Error, "topics",
        "topic '" + name + "': the subscription's executor is full or has stopped");
  }
}

void TopicReader::State::schedule() {
  if (!consumer || scheduled.exchange(true)) return;
  post([](State& self) { self.hand_over(); });
}

void TopicReader::State::hand_over() {
  scheduled = false;  // before taking: what comes from now on asks for another turn
  if (!reader) return;
  const auto hand = [this](const dds::Sample& sample) {
    if (!closed && !ending) guarded([&] { hand_over(sample); });
  };
  if (reader->take(hand, kTurn) == kTurn) schedule();
}

void TopicReader::State::hand_over(const dds::Sample& sample) {
  if (!decode(sample, value.get())) return;
  began = Clock::now();
  const std::unique_ptr<State, void (*)(State*)> ends(
      this, [](State* self) { self->began = Clock::time_point(); });
  consumer(value.get());
}

void TopicReader::State::tell_if_stuck() {
  const Clock::time_point since = began;
  if (since == Clock::time_point() || Clock::now() - since < kTooLong || told_stuck.exchange(true))
    return;
  log(LogLevel::Warning, "topics",
      "topic '" + name +
          "': a callback has not returned for a second; the values that come meanwhile wait, and "
          "the oldest are dropped, as are those of other subscriptions on its thread; let it "
          "return, or give it an executor of its own (SubscriptionOptions)");
}

bool TopicReader::State::decode(const dds::Sample& sample, void* into) {
  if (sample.state == dds::InstanceState::Disposed) {
    ++received;
    if (options.on_disposed) options.on_disposed(sample.key);
    return false;
  }
  try {
    type.support->decode(into, sample.cdr, idl::kEncapsulation.size());
  } catch (const idl::MalformedSample& error) {
    report_malformed(error.what());
    return false;
  }
  ++received;
  return true;
}

void TopicReader::State::report_malformed(const std::string& reason) {
  if (malformed.fetch_add(1) > 0) return;
  log(LogLevel::Warning, "topics",
      "topic '" + name + "': a sample is no " + std::string(type.support->name) +
          " and was dropped: " + reason +
          "; further ones are only counted. Do both sides use the same IDL?");
}

bool TopicReader::take(void* value) {
  if (state_->consumer) {
    throw InvalidArgument("topic '" + state_->name +
                          "': a subscription with a callback has no values to take; they go to the "
                          "callback: subscribe without one, to poll");
  }
  bool found = false;
  const auto keep = [&](const dds::Sample& sample) { found = state_->decode(sample, value); };
  while (!found && state_->reader->take(keep, 1) == 1) {
  }
  return found;
}

std::size_t TopicReader::publishers() const { return state_->reader->matched_writers().size(); }

SubscriptionCounters TopicReader::State::counters() const {
  const dds::ReceiveCounters of_reader = reader->counters();
  return {received, of_reader.replaced, of_reader.expired, malformed + of_reader.malformed,
          missed_deadlines};
}

SubscriptionCounters TopicReader::counters() const { return state_->counters(); }

}  // namespace skein::topics
