#include "same_host/futex.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;

namespace {

/// A thread in `waits`, which is known to sleep there.
class Sleeper {
 public:
  explicit Sleeper(const std::function<void()>& waits)
      : thread_([this, waits] {
          id_ = gettid();
          waits();
          over_ = true;
        }) {
    REQUIRE(eventually([this] { return id_ != 0 && state() == 'S'; }));
  }
  ~Sleeper() { thread_.join(); }
  bool ends() const {
    return eventually([this] { return over_.load(); });
  }

 private:
  char state() const {
    std::ifstream file("/proc/self/task/" + std::to_string(id_) + "/stat");
    std::string line;
    std::getline(file, line);
    const auto name_end = line.rfind(')');
    return name_end == std::string::npos ? '?' : line[name_end + 2];
  }

  std::atomic<pid_t> id_{0};
  std::atomic<bool> over_{false};
  std::thread thread_;
};

/// Long after a test has failed, so that it ends.
Instant late() { return std::chrono::steady_clock::now() + 3 * test::kPatience; }

void sleep_on(Word& word) { futex_wait(word, 1, late()); }

}  // namespace

TEST_CASE("who sleeps on a word is woken, by the end at the latest, however many there are") {
  const std::size_t count = GENERATE(1, 2, 3, 4);
  std::vector<Word> words(count);
  for (Word& word : words) word = 1;
  std::vector<std::unique_ptr<Sleeper>> sleepers;
  for (std::size_t i = 0; i < count; ++i) {
    sleepers.push_back(std::make_unique<Sleeper>([&words, i] { sleep_on(words[i]); }));
  }
  {
    Wakes wakes;
    for (Word& word : words) {
      word = 0;
      wakes.add(word);
    }
  }
  for (const auto& sleeper : sleepers) CHECK(sleeper->ends());
  for (const Word& word : words) CHECK(word == 0);
}

TEST_CASE("what a hostile client makes of its own word keeps nobody else asleep") {
  Word sound{1};
  Word hostile{static_cast<std::uint32_t>(gettid())};
  const bool hostile_first = GENERATE(true, false);
  const Sleeper sleeper([&] { sleep_on(sound); });
  SECTION("negative") { hostile = 0x8000'0000; }
  SECTION("such that the kernel refuses to wake anybody") {
    // As the lock of a mutex with priority inheritance, which this thread holds.
    const Sleeper waits_for_lock([&] {
      const auto until = to_timespec(late());
      syscall(SYS_futex, &hostile, FUTEX_LOCK_PI2, 0, &*until, nullptr, 0);
      syscall(SYS_futex, &hostile, FUTEX_UNLOCK_PI, 0, nullptr, nullptr, 0);
    });
    sound = 0;
    {
      Wakes wakes;
      wakes.add(hostile_first ? hostile : sound);
      wakes.add(hostile_first ? sound : hostile);
    }
    CHECK(sleeper.ends());
    syscall(SYS_futex, &hostile, FUTEX_UNLOCK_PI, 0, nullptr, nullptr, 0);
    CHECK(waits_for_lock.ends());
  }
  sound = 0;
  {
    Wakes wakes;
    wakes.add(hostile_first ? hostile : sound);
    wakes.add(hostile_first ? sound : hostile);
  }
  CHECK(sleeper.ends());
}
