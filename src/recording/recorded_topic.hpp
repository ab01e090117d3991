#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "dds/port/port.hpp"
#include "skein/inspector.hpp"

namespace skein::recording {

/// The readers of a topic that is recorded. A publisher that comes later may be of another system,
/// or offer less than was requested so far: then a further reader joins, and a publisher that
/// several readers hear is recorded from the first of them.
class RecordedTopic {
 public:
  /// `consumer` runs on a vendor's thread, with values as they travel, and disposals of instances.
  using Consumer = std::function<void(const dds::Sample& sample)>;

  explicit RecordedTopic(Consumer consumer)
      : heard_(std::make_shared<Heard>(std::move(consumer))) {}

  /// Hears all of its publishers from now on. Throws as Participant::create_reader().
  void follow(dds::Participant& participant, const KnownTopic& topic);

 private:
  /// Which readers hear a writer. Thread-safe.
  class Heard {
   public:
    explicit Heard(Consumer consumer) : consumer_(std::move(consumer)) {}
    void note(std::size_t reader, const Guid& writer, bool matched);
    void take(std::size_t reader, const dds::Sample& sample);

   private:
    const Consumer consumer_;
    std::mutex mutex_;
    std::map<Guid, std::set<std::size_t>> readers_;
  };

  /// Reliable, transient-local, exclusive.
  using Requested = std::tuple<bool, bool, bool>;

  std::map<Requested, std::set<std::string>> systems_;  // in which it is read
  std::shared_ptr<Heard> heard_;
  std::vector<std::unique_ptr<dds::Reader>> readers_;  // last: they go first
};

}  // namespace skein::recording
