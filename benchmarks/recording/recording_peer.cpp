#include <unistd.h>

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <sstream>
#include <thread>

#include "calls/skein_peer.hpp"
#include "echo.idl.hpp"
#include "entity/entity_access.hpp"
#include "harness/peer.hpp"
#include "introspection/topic_tap.hpp"
#include "recording/recorder.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

using namespace std::chrono_literals;

/// As long as the command's.
constexpr auto kLookAgain = 1s;
constexpr auto kAnswerPatience = 2s;

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / name) {}
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  std::string path() const { return path_.string(); }

 private:
  const std::filesystem::path path_;
};

std::uint64_t written(const recording::WriterStatistics& statistics, const std::string& topic) {
  for (const auto& channel : statistics.channels) {
    if (channel.topic == topic) return channel.written;
  }
  return 0;
}

/// Looks again and again for what is new in its domain, in a thread of its own.
std::jthread looking(const std::function<void()>& look) {
  return std::jthread([look](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      look();
      std::this_thread::sleep_for(kLookAgain);
    }
  });
}

/// Counts what comes on all topics. Thread-safe.
class Counter {
 public:
  explicit Counter(Entity& entity) : entity_(entity), inspector_(entity) {}

  void look() {
    for (const KnownTopic& topic : known_topics(inspector_, kAnswerPatience)) {
      std::lock_guard lock(mutex_);
      if (!topic.has_publisher() || counts_.contains(topic.name)) continue;
      std::atomic<std::uint64_t>& count = counts_[topic.name];
      readers_.push_back(tap_topic(EntityAccess::participant(entity_), topic, topic.systems(),
                                   {[&count](const dds::Sample&) { ++count; }}));
    }
  }

  std::string of(const std::string& topic) const {
    std::lock_guard lock(mutex_);
    const auto found = counts_.find(topic);
    return std::to_string(found == counts_.end() ? 0 : found->second.load());
  }

 private:
  Entity& entity_;
  Inspector inspector_;
  mutable std::mutex mutex_;
  std::map<std::string, std::atomic<std::uint64_t>> counts_;
  std::vector<std::unique_ptr<dds::Reader>> readers_;
};

/// Publishes on two topics.
class Publishing {
 public:
  explicit Publishing(Entity& entity) {
    for (const bool reliable : {true, false}) {
      TopicQos qos;
      qos.reliable = reliable;
      const std::string name = reliable ? "reliable" : "best_effort";
      publishers_.emplace(name, entity.publisher<benchmark::Frame>(name, qos));
    }
  }

  std::string await_subscribers() const {
    for (const auto& [name, publisher] : publishers_) {
      while (publisher.subscribers() == 0) std::this_thread::sleep_for(1ms);
    }
    return "subscribed";
  }

  std::string publish(const std::string& words) {
    std::istringstream in(words);
    std::string name;
    std::size_t size = 0;
    std::size_t count = 0;
    in >> name >> size >> count;
    Publisher<benchmark::Frame>& publisher = publishers_.at(name);
    const benchmark::Frame frame{Content(size, 7)};
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < count; ++i) publish(publisher, frame);
    const auto took = std::chrono::steady_clock::now() - begin;
    return "times " + std::to_string(std::chrono::nanoseconds(took).count());
  }

 private:
  static void publish(Publisher<benchmark::Frame>& publisher, const benchmark::Frame& frame) {
    const auto end = std::chrono::steady_clock::now() + 10s;
    while (true) {
      try {
        return publisher.publish(frame);
      } catch (const Overloaded&) {
        if (std::chrono::steady_clock::now() > end) throw;
      }
    }
  }

  std::map<std::string, Publisher<benchmark::Frame>> publishers_;
};

}  // namespace

void record(const EntityOptions& options) {
  const TemporaryFile file("skein_bench_" + std::to_string(getpid()) + ".mcap");
  Entity entity(options);
  recording::Recorder recorder(entity, file.path(), {});
  const std::jthread thread = looking([&] { recorder.look(kAnswerPatience); });
  run_commands({{"recorded",
                 [&](const std::string& topic) {
                   return std::to_string(written(recorder.statistics(), topic));
                 }},
                {"dropped", [&](const std::string&) {
                   return std::to_string(recorder.statistics().dropped());
                 }}});
}

void count(const EntityOptions& options) {
  Entity entity(options);
  Counter counter(entity);
  const std::jthread thread = looking([&] { counter.look(); });
  run_commands({{"recorded", [&](const std::string& topic) { return counter.of(topic); }}});
}

void publish(const EntityOptions& options) {
  Entity entity(options);
  Publishing publishing(entity);
  run_commands({{"subscribed", [&](const std::string&) { return publishing.await_subscribers(); }},
                {"publish", [&](const std::string& words) { return publishing.publish(words); }}});
}

}  // namespace skein::benchmarks
