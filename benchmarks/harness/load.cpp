#include "harness/load.hpp"

#include <sys/prctl.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <exception>
#include <latch>
#include <sstream>
#include <thread>

#include "harness/skipped.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;
using Times = std::vector<std::int64_t>;

std::vector<std::size_t> numbers_of(const std::string& text, std::size_t count) {
  std::istringstream words(text);
  std::vector<std::size_t> numbers(count);
  for (std::size_t& number : numbers) words >> number;
  if (!words) throw Internal("'" + text + "' are not " + std::to_string(count) + " numbers");
  return numbers;
}

std::string times_text(const Times& times) {
  std::string text = "times";
  for (const std::int64_t time : times) text += ' ' + std::to_string(time);
  return text;
}

// The time from `begin` until the reply was there.
std::int64_t timed(const EchoCall& call, const Content& content, Clock::time_point begin) {
  Clock::time_point end;
  call(content, [&](std::span<const std::uint8_t> reply) {
    end = Clock::now();
    if (!std::ranges::equal(reply, content)) throw Internal("a reply differs from what was sent");
  });
  return std::chrono::nanoseconds(end - begin).count();
}

Times closed_loop(const EchoCall& call, const Content& content, std::size_t count) {
  Times times(count);
  for (std::int64_t& time : times) time = timed(call, content, Clock::now());
  return times;
}

// Timers come late, by more than a call takes: who calls at an instant is awake before.
constexpr std::chrono::microseconds kTimersLate{200};

// Without the 50 us by which Linux lets sleepers oversleep.
void sleep_until(Clock::time_point instant) {
  prctl(PR_SET_TIMERSLACK, 1);
  const auto since = std::chrono::nanoseconds(instant.time_since_epoch()).count();
  const timespec time{since / 1'000'000'000, since % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

/// Clients that call at once, a thread each: from when all threads have begun, so that none makes
/// its calls alone.
Times all_at_once(const std::vector<const EchoCall*>& calls, const Content& content,
                  std::size_t count) {
  std::vector<Times> times(calls.size());
  std::vector<std::exception_ptr> errors(calls.size());
  std::vector<std::thread> threads;
  std::latch begun(static_cast<std::ptrdiff_t>(calls.size()));
  for (std::size_t i = 0; i < calls.size(); ++i) {
    threads.emplace_back([&, i] {
      begun.arrive_and_wait();
      try {
        times[i] = closed_loop(*calls[i], content, count);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  Times all;
  for (const Times& some : times) all.insert(all.end(), some.begin(), some.end());
  return all;
}

void keep_in_flight(const StartEcho& start, const Content& content, std::size_t count,
                    std::size_t depth) {
  std::deque<std::function<void()>> waiting;
  for (std::size_t i = 0; i < count; ++i) {
    if (waiting.size() == depth) {
      waiting.front()();
      waiting.pop_front();
    }
    waiting.push_back(start(content));
  }
  for (const auto& wait : waiting) wait();
}

}  // namespace

Commands Load::commands() {
  const auto bound = [this](std::string (Load::*command)(const std::string&)) {
    return [this, command](const std::string& rest) { return (this->*command)(rest); };
  };
  return {{"call", bound(&Load::one_by_one)},
          {"paced", bound(&Load::paced)},
          {"crowd", bound(&Load::crowd)},
          {"pipelined", bound(&Load::pipelined)},
          {"idle", bound(&Load::idle)}};
}

// The last octet too: a truncated or stale reply differs in it.
Content Load::next_content(std::size_t size) {
  const std::size_t turn = turn_++;
  Content content(size, static_cast<std::uint8_t>(turn));
  for (std::size_t i = 0; i < size; i += 97) content[i] = static_cast<std::uint8_t>(i / 97 + turn);
  return content;
}

std::vector<const EchoCall*> Load::clients(std::size_t count) {
  if (count > 1 && !client_.another) throw Skipped("this program has but one client");
  while (1 + others_.size() < count) others_.push_back(client_.another());
  std::vector<const EchoCall*> calls{&client_.call};
  for (std::size_t i = 1; i < count; ++i) calls.push_back(&others_[i - 1]);
  return calls;
}

std::string Load::one_by_one(const std::string& what) {
  const auto numbers = numbers_of(what, 2);
  return times_text(closed_loop(client_.call, next_content(numbers[0]), numbers[1]));
}

std::string Load::paced(const std::string& what) {
  const auto numbers = numbers_of(what, 3);
  const Content content = next_content(numbers[0]);
  const std::chrono::microseconds interval(numbers[2]);
  Times times(numbers[1]);
  auto intended = Clock::now() + interval;
  for (std::int64_t& time : times) {
    sleep_until(intended - kTimersLate);
    while (Clock::now() < intended) {
    }
    time = timed(client_.call, content, intended);
    intended += interval;
  }
  return times_text(times);
}

std::string Load::crowd(const std::string& what) {
  const auto numbers = numbers_of(what, 3);
  return times_text(all_at_once(clients(numbers[0]), next_content(numbers[1]), numbers[2]));
}

std::string Load::pipelined(const std::string& what) {
  const auto numbers = numbers_of(what, 3);
  const std::size_t count = numbers[1], depth = numbers[2];
  const Content content = next_content(numbers[0]);
  const auto threads = client_.start ? std::vector<const EchoCall*>() : clients(depth);
  const auto begin = Clock::now();
  if (client_.start) {
    keep_in_flight(client_.start, content, count, depth);
  } else {
    all_at_once(threads, content, (count + depth - 1) / depth);
  }
  const auto took = std::chrono::nanoseconds(Clock::now() - begin).count();
  return times_text({took / static_cast<std::int64_t>(count)});
}

std::string Load::idle(const std::string& what) {
  clients(1 + numbers_of(what, 1)[0]);
  return "idle";
}

}  // namespace skein::benchmarks
