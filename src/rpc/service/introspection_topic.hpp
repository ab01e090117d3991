#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "dds/port/port.hpp"
#include "rpc/wire/shared_use.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"
#include "skein/executor.hpp"
#include "skein/guid.hpp"

/// How entities tell of themselves: topics that anybody may read, mostly best effort, and on which
/// an entity writes only while somebody does.
namespace skein::introspection {

struct CallEvents;
struct CallRecords;
struct Decision;
struct LogLine;
struct ServiceStatistics;

/// One of these topics, without its type. The texts are literals.
struct AnyTopic {
  const char* name;
  const char* type_name;
  bool keyed = false;
  std::uint32_t history_depth;           ///< Of each key.
  bool reliable = false;                 ///< Otherwise best effort; all are volatile.
  std::chrono::milliseconds interval{};  ///< Between two samples of an entity; 0: as it happens.
  bool recorded = false;                 ///< By a Recorder, as it travels.
  bool viewed = false;                   ///< By `skein view`.

  dds::Topic dds_topic() const { return {name, type_name, keyed}; }
  dds::Qos qos() const;
};

template <class T>
struct Topic : AnyTopic {};

/// The topics on which each entity tells of itself, with the types of introspection.idl. Tools that
/// record, view or imitate entities go by this table.
inline constexpr std::tuple kTopics{
    Topic<CallEvents>{{.name = "skein/calls",
                       .type_name = "skein::introspection::CallEvents",
                       .history_depth = 64,
                       .interval = std::chrono::milliseconds(25),
                       .recorded = true,
                       .viewed = true}},
    // A Recorder takes them apart, see RecordedCalls.
    Topic<CallRecords>{{.name = "skein/call_records",
                        .type_name = "skein::introspection::CallRecords",
                        .history_depth = 256,
                        .reliable = true,
                        .interval = std::chrono::milliseconds(25)}},
    Topic<Decision>{{.name = "skein/decisions",
                     .type_name = "skein::introspection::Decision",
                     .history_depth = 64,
                     .recorded = true,
                     .viewed = true}},
    Topic<LogLine>{{.name = "skein/log",
                    .type_name = "skein::introspection::LogLine",
                    .history_depth = 256,
                    .reliable = true,
                    .interval = std::chrono::milliseconds(200)}},
    Topic<ServiceStatistics>{{.name = "skein/statistics",
                              .type_name = "skein::introspection::ServiceStatistics",
                              .keyed = true,
                              .history_depth = 1,
                              .interval = std::chrono::milliseconds(1000),
                              .viewed = true}},
};

/// The one that carries values of that type.
template <class T>
inline constexpr const Topic<T>& kTopic = std::get<Topic<T>>(kTopics);

/// Calls `visit` with each.
template <class Visit>
void for_each_topic(const Visit& visit) {
  std::apply([&](const auto&... topic) { (visit(topic), ...); }, kTopics);
}

/// A Publisher or BatchPublisher without its type.
class AnyPublisher {
 public:
  /// `participant` and `control` live until close(). Throws what Participant::create_writer()
  /// throws.
  AnyPublisher(dds::Participant& participant, Executor& control, const AnyTopic& topic);
  /// As close().
  ~AnyPublisher() { close(); }

  /// Whether somebody reads; false once it is closed. The look at a flag.
  bool on() const noexcept { return on_.load(std::memory_order_relaxed); }

  /// From now on `begin` is posted each time that a reader comes, and now if one is there
  /// already.
  void when_read(std::function<void()> begin);

  /// Runs the task on `control`, however full that is, unless close() has been called by then. Not
  /// after `control` has been stopped.
  void post(std::function<void()> task);

  /// Waits for a short time until reliable readers have what was written. When it returns, no task
  /// that was posted here runs or will run, and nothing of the participant or of `control` is in
  /// use any more. Twice is no error. Not from a listener, nor from a task of `control`.
  void close();

 protected:
  /// What cannot be sent, or not be encoded, is logged. Does nothing once it is closed.
  template <class Encode>
  void write(const Encode& encode, const dds::KeyHash& key = {}) {
    const std::shared_ptr<dds::Writer> writer = open_writer();
    if (!writer) return;
    try {
      writer->write(encode(), key);
    } catch (const Error& error) {
      log_not_sent(error);
    }
  }

 private:
  std::shared_ptr<dds::Writer> open_writer();
  void log_not_sent(const Error& error) const;
  void on_reader(bool matched);
  void update();
  void hand_to_control(std::function<void()> task);

  Executor& control_;
  const AnyTopic topic_;
  std::atomic<bool> on_{false};
  std::mutex mutex_;
  std::size_t readers_ = 0;
  std::function<void()> begin_;
  std::shared_ptr<dds::Writer> writer_;  // none once it is closed
  rpc::SharedUse writers_;               // which its tasks on `control` hold, too, while they run
};

/// Writes an entity's values on one of these topics, while somebody reads it. Off, it costs the
/// look at a flag. On, `control` encodes and writes them one by one; further ones are dropped while
/// kCapacity wait. Thread-safe.
template <class T>
class Publisher : public AnyPublisher {
 public:
  static constexpr std::size_t kCapacity = 4096;

  Publisher(dds::Participant& participant, Executor& control, const Topic<T>& topic)
      : AnyPublisher(participant, control, topic) {}

  /// Does nothing while nobody reads.
  void publish(T value) {
    if (!on()) return;
    const auto place = std::make_shared<Place>(waiting_);
    if (place->number > kCapacity) return;
    post([this, place, value = std::move(value)] {
      write([&] { return idl::encode_message(value); }, key_of(value));
    });
  }

 private:
  /// Among those that wait, as long as it lives.
  struct Place {
    explicit Place(std::shared_ptr<std::atomic<std::size_t>> waiting_)
        : waiting(std::move(waiting_)), number(++*waiting) {}
    ~Place() { --*waiting; }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    const std::shared_ptr<std::atomic<std::size_t>> waiting;
    const std::size_t number;
  };

  static dds::KeyHash key_of(const T& value) {
    if constexpr (requires { key_hash(value); }) {
      return key_hash(value);
    } else {
      return {};
    }
  }

  const std::shared_ptr<std::atomic<std::size_t>> waiting_ =
      std::make_shared<std::atomic<std::size_t>>(0);
};

/// The value that a sample holds which is alive. Throws InvalidArgument where it holds none, or one
/// of another key than the sample's.
template <class T>
T decoded(const dds::Sample& sample) {
  T value = idl::decode_message<T>(sample.cdr);
  if constexpr (requires { key_hash(value); }) {
    if (key_hash(value) != sample.key) throw InvalidArgument("its key is not its value's");
  }
  return value;
}

/// A Reader without its type.
class AnyReader {
 public:
  /// Runs on a vendor's thread: it must return soon.
  struct Listener {
    /// What it throws refuses the sample.
    std::function<void(const dds::Sample& sample)> on_sample;
    std::function<void(const Guid& writer)> on_writer_gone{};
  };

  /// `participant` outlives the reader. Throws what Participant::create_reader() throws.
  AnyReader(dds::Participant& participant, const AnyTopic& topic, Listener listener);

  /// Samples that were not believed, since the start. The log names the first.
  std::uint64_t refused() const noexcept { return refused_; }

 private:
  void receive(const dds::Sample& sample);

  const AnyTopic topic_;
  const Listener listener_;
  std::atomic<std::uint64_t> refused_{0};
  std::unique_ptr<dds::Reader> reader_;  // last: goes first, and no listener runs after that
};

/// Reads one of these topics, of all entities of the domain whatever their vendor: for tools. Its
/// existence switches the publishers on.
template <class T>
class Reader : public AnyReader {
 public:
  /// `consumer` runs on a vendor's thread: it must return soon. What it throws refuses the value.
  Reader(dds::Participant& participant, const Topic<T>& topic,
         std::function<void(const T& value)> consumer)
      : AnyReader(participant, topic,
                  Listener{[consumer = std::move(consumer)](const dds::Sample& sample) {
                    if (sample.state == dds::InstanceState::Alive) consumer(decoded<T>(sample));
                  }}) {}
};

}  // namespace skein::introspection
