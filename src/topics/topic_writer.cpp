#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "core/log.hpp"
#include "dds/port/port.hpp"
#include "idl/encode_value.hpp"
#include "register.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/error.hpp"
#include "skein/topics.hpp"
#include "wire_topic.hpp"

namespace skein::topics {

namespace {

/// Best effort, so large a value hardly arrives: it travels in more pieces than a receiver's socket
/// buffer has room for, and each that is lost loses it.
constexpr std::size_t kTooLarge = 1 << 20;

/// Of the port's Qos, 0 is no limit; here it would let a publisher wait for nobody.
void check(const TopicQos& qos, const std::string& topic) {
  if (!qos.reliable || qos.history_depth || qos.max_samples > 0) return;
  throw InvalidArgument("topic '" + topic +
                        "': `max_samples` is 0, by which no value may be unacknowledged; give it "
                        "1 or more, or set `history_depth`");
}

}  // namespace

struct TopicWriter::State {
  State(std::string name_, const TopicType& type_, bool best_effort_)
      : name(std::move(name_)), type(type_), best_effort(best_effort_) {}

  void tell_if_too_large(std::size_t size) {
    if (!best_effort || size <= kTooLarge || told_too_large.exchange(true)) return;
    log(LogLevel::Warning, "topics",
        "topic '" + name + "': a value of " + std::to_string(size) +
            " bytes is published best effort, by which more than 1 MiB arrives seldom or never; "
            "let both sides ask for TopicQos{}, which sends again what is lost, or set `reliable`; "
            "further values are not told of");
  }

  Bytes spare_buffer() {
    std::lock_guard lock(mutex);
    return std::move(spare);
  }
  void give_back(Bytes buffer) {
    std::lock_guard lock(mutex);
    spare = std::move(buffer);
  }

  const std::string name;
  const TopicType type;
  const bool best_effort;
  std::atomic<bool> told_too_large{false};
  std::mutex mutex;
  Bytes spare;  // for the next value, so that a steady flow allocates nothing
  std::atomic<std::uint64_t> published{0};
  std::atomic<std::uint64_t> missed_deadlines{0};
  std::unique_ptr<dds::Writer> writer;   // goes early: its listener uses the rest
  std::optional<Register::Entry> entry;  // goes first: it uses all
};

TopicWriter::TopicWriter(dds::Participant& participant, const std::string& name,
                         const TopicType& type, const TopicQos& qos, Register* known)
    : state_(std::make_unique<State>(name, type, !qos.reliable)) {
  check(qos, name);
  dds::WriterListener listener;
  listener.on_deadline_missed = [state = state_.get()](const Guid&) { ++state->missed_deadlines; };
  listener.on_incompatible = [](const dds::Incompatibility& why) {
    log(LogLevel::Warning, "topics", why.explanation);
  };
  state_->writer =
      participant.create_writer(wire_topic(name, type), wire_qos(qos, type), std::move(listener));
  state_->entry.emplace(known, [state = state_.get(), qos] {
    return Endpoint{.name = state->name,
                    .type = state->type,
                    .qos = qos,
                    .publishes = true,
                    .matched = state->writer->matched_readers().size(),
                    .samples = state->published,
                    .missed_deadlines = state->missed_deadlines};
  });
}

TopicWriter::~TopicWriter() = default;

void TopicWriter::publish(const void* value) {
  Bytes message = state_->spare_buffer();
  message.clear();
  message.append(encapsulation(state_->type.support->representation));
  idl::encode_value(*state_->type.support, value, message);
  const auto key_of = state_->type.key_of;
  publish(message, key_of != nullptr ? key_of(value) : Guid{});
  state_->give_back(std::move(message));
}

void TopicWriter::publish(std::span<const std::byte> message, const Guid& key) {
  state_->tell_if_too_large(message.size());
  state_->writer->write(message, key);
  ++state_->published;
}

void TopicWriter::dispose(const void* value) {
  state_->writer->dispose(state_->type.key_of(value));
  ++state_->published;
}

bool TopicWriter::wait_for_acknowledgments(std::chrono::milliseconds timeout) {
  constexpr std::chrono::hours kLongest(24 * 365);  // vendors' clocks count no further than theirs
  return state_->writer->wait_for_acknowledgments(
      std::min<std::chrono::milliseconds>(timeout, kLongest));
}

std::size_t TopicWriter::subscribers() const { return state_->writer->matched_readers().size(); }

PublisherCounters TopicWriter::counters() const {
  return {state_->published, state_->missed_deadlines};
}

}  // namespace skein::topics
