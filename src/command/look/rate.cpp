#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>
#include <vector>

#include "command/commands.hpp"
#include "command/print/wrapped.hpp"
#include "entity/entity_access.hpp"
#include "introspection/topic_tap.hpp"
#include "skein/entity.hpp"
#include "topic_survey.hpp"

namespace skein::command {
namespace {

using Time = std::chrono::steady_clock::time_point;

/// What came, and when.
class Arrivals {
 public:
  void add(std::size_t size) {
    std::lock_guard lock(mutex_);
    times_.push_back(std::chrono::steady_clock::now());
    octets_ += size;
  }

  /// Figures of what came since the last call.
  nlohmann::ordered_json take(double seconds) {
    std::vector<Time> times;
    std::size_t octets = 0;
    {
      std::lock_guard lock(mutex_);
      times.swap(times_);
      octets = std::exchange(octets_, 0);
      if (!times.empty()) times_since_last(times);
    }
    return {{"values_per_second", static_cast<double>(times.size()) / seconds},
            {"bytes_per_second", static_cast<double>(octets) / seconds},
            {"interval_ms", intervals()}};
  }

 private:
  void times_since_last(const std::vector<Time>& times) {
    intervals_.clear();
    for (const Time time : times) {
      if (last_ != Time()) {
        intervals_.push_back(std::chrono::duration<double, std::milli>(time - last_).count());
      }
      last_ = time;
    }
  }

  nlohmann::ordered_json intervals() {
    if (intervals_.empty()) return nullptr;
    std::ranges::sort(intervals_);
    double sum = 0;
    for (const double each : intervals_) sum += each;
    const double mean = sum / static_cast<double>(intervals_.size());
    double squares = 0;
    for (const double each : intervals_) squares += (each - mean) * (each - mean);
    nlohmann::ordered_json json{
        {"least", intervals_.front()},
        {"mean", mean},
        {"greatest", intervals_.back()},
        {"deviation", std::sqrt(squares / static_cast<double>(intervals_.size()))}};
    intervals_.clear();
    return json;
  }

  std::mutex mutex_;
  std::vector<Time> times_;
  std::size_t octets_ = 0;
  Time last_{};
  std::vector<double> intervals_;
};

void print_rates(const nlohmann::ordered_json& figures) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), "%.1f values/s  %.0f bytes/s",
                figures["values_per_second"].get<double>(),
                figures["bytes_per_second"].get<double>());
  std::string line = text.data();
  if (const auto& interval = figures["interval_ms"]; !interval.is_null()) {
    std::snprintf(text.data(), text.size(),
                  "  interval least %.3f  mean %.3f  greatest %.3f  deviation %.3f ms",
                  interval["least"].get<double>(), interval["mean"].get<double>(),
                  interval["greatest"].get<double>(), interval["deviation"].get<double>());
    line += text.data();
  }
  std::printf("%s\n", folded(line, terminal_width()).c_str());
}

}  // namespace

int show_rate(const TopicArguments& arguments) {
  constexpr double kInterval = 1;
  const Interruption interruption;
  Entity entity = join(arguments, "rate");
  Inspector inspector(entity, interruption.gives_up());
  const KnownTopic topic = await_topic(inspector, arguments.topic, arguments.wait, interruption);
  Arrivals arrivals;
  const auto reader =
      tap_topic(EntityAccess::participant(entity), topic, topic.systems(),
                {[&](const dds::Sample& value) { arrivals.add(value.cdr.size()); }});
  double watched = 0;
  std::uint64_t lines = 0;
  while ((arguments.seconds <= 0 || watched < arguments.seconds) &&
         (arguments.count == 0 || lines < arguments.count)) {
    if (interruption.wait(kInterval)) break;
    watched += kInterval;
    ++lines;
    const auto figures = arrivals.take(kInterval);
    arguments.json ? void(std::printf("%s\n", figures.dump().c_str())) : print_rates(figures);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace skein::command
