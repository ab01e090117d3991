#include "mission_participant.hpp"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>

#include "skein/error.hpp"
#include "stepped_time.hpp"
#include "time_keeper.hpp"

namespace reconnaissance {
namespace {

using namespace std::chrono_literals;

// Whoever has said nothing for this time says again what it said last: that it is there, and what
// the time's keeper may not have heard before the two had met.
constexpr auto kTellAgain = 250ms;

std::uint64_t new_life() {
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

}  // namespace

int period_of(std::int64_t rate_hz) {
  constexpr int kTicksPerSecond = 50;
  for (const int period : kPeriods)
    if (rate_hz * period == kTicksPerSecond) return period;
  throw skein::InvalidArgument(fmt::format(
      "nobody can take part {} times a second; 1, 2, 5, 10, 25 and 50 are possible", rate_hz));
}

Participant::Participant(skein::Entity& entity, int rate_hz, Work work)
    : entity_(entity),
      stepped_(dynamic_cast<SteppedTime*>(&entity.clock())),
      work_(std::move(work)),
      told_{entity.options().name, new_life(), period_of(rate_hz), -1, false},
      time_(entity.subscription<recon::MissionTime>(
          time_topic(told_.period_ticks), time_qos(),
          [this](const recon::MissionTime& time) { hear(time); }, {.executor = &hearing_})) {}

Participant::~Participant() {
  if (number_ != 0) stepped_->leave(number_);
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
  told_.leaves = true;
  try {
    acknowledgments_->publish(told_);
    acknowledgments_->wait_for_acknowledgments(kTellAgain);
  } catch (const skein::Error&) {
    // It is missed soon.
  }
}

void Participant::start() {
  if (stepped_) {
    number_ = stepped_->join(told_.period_ticks, [this](Tick tick) {
      std::unique_lock lock(mutex_);
      begun_ = tick;
      do_work(lock);
    });
    return;
  }
  // Not sooner: the time's keeper counts publishers to know who is there.
  acknowledgments_.emplace(
      entity_.publisher<recon::Acknowledgment>(kAcknowledgments, acknowledgment_qos()));
  thread_ = std::jthread([this](const std::stop_token& stop) { take_part(stop); });
}

void Participant::hear(const recon::MissionTime& time) {
  std::lock_guard lock(mutex_);
  if (!run_) run_ = time.run;
  if (*run_ != time.run) return;  // of another simulator, whose time is not this one's
  begun_ = std::max(begun_, static_cast<Tick>(time.tick));
}

void Participant::take_part(const std::stop_token& stop) {
  pthread_setname_np(pthread_self(), "mission-time");
  const std::stop_callback stops(stop, [this] { hearing_.post([] {}); });
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (begun_ > present_) {
      do_work(lock);
      continue;
    }
    acknowledge(lock);
    lock.unlock();
    hearing_.run_until(tell_again_, [&] {
      std::lock_guard looks(mutex_);
      return begun_ > present_ || stop.stop_requested();
    });
    lock.lock();
  }
}

void Participant::do_work(std::unique_lock<std::mutex>& lock) {
  present_ = begun_;
  const Tick tick = present_;
  std::string failure;
  lock.unlock();
  try {
    work_(tick);
  } catch (const std::exception& error) {
    failure = error.what();
  }
  lock.lock();
  if (failure != failure_ && !failure.empty())
    fmt::print(stderr, "{}, tick {}: {}\n", told_.participant, tick, failure);
  failure_ = failure;
  tell_again_ = {};
}

/// Tells what is new, and otherwise now and then what was told before.
void Participant::acknowledge(std::unique_lock<std::mutex>& lock) {
  const skein::Instant now = entity_.clock().now();
  if (present_ == told_.tick && now < tell_again_) return;
  told_.tick = present_;
  tell_again_ = now + kTellAgain;
  const recon::Acknowledgment told = told_;
  lock.unlock();
  try {
    acknowledgments_->publish(told);
  } catch (const skein::Error& error) {
    fmt::print(stderr, "{}: {}\n", told.participant, error.what());
  }
  lock.lock();
}

std::string Participant::failure() const {
  std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace reconnaissance
