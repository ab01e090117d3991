#include "mission/process/progress_report.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>

#include "brokerless_discovery/broker.hpp"
#include "mission/process/ready.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::launch;
using namespace std::chrono_literals;

namespace {

/// A launcher's end of the pipe, which this process takes for its launcher's.
class Pipe {
 public:
  Pipe() {
    REQUIRE(::pipe2(ends_, O_NONBLOCK) == 0);
    ::setenv(kReadyVariable, std::to_string(ends_[1]).c_str(), 1);
  }
  ~Pipe() {
    ::unsetenv(kReadyVariable);
    ::close(ends_[0]);
    ::close(ends_[1]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  /// Whether so many signs come; what came before counts.
  bool brings(std::size_t signs) {
    return test::eventually([&] {
      char text[256];
      const auto size = ::read(ends_[0], text, sizeof text);
      if (size > 0) all_.append(text, static_cast<std::size_t>(size));
      return all_.size() >= signs;
    });
  }
  /// Throws away what has come.
  void clear() {
    char text[256];
    while (::read(ends_[0], text, sizeof text) > 0) {
    }
    all_.clear();
  }
  bool is_empty() {
    char text[1];
    return ::read(ends_[0], text, 1) < 0;
  }

 private:
  int ends_[2] = {-1, -1};
  std::string all_;
};

}  // namespace

TEST_CASE("An entity reports progress as long as its control thread makes some") {
  Pipe pipe;
  Entity entity({.name = "a", .vendor = dds::load_vendor("loopback")});
  report_ready();
  const ProgressReport report(entity, 20ms);
  REQUIRE(pipe.brings(10));

  std::atomic<bool> blocked{false}, released{false};
  REQUIRE(entity.check_progress([&](const std::string&) {
    blocked = true;
    blocked.notify_all();
    released.wait(false);
  }));
  blocked.wait(false);
  pipe.clear();
  // One more turn of the clock, in which it would have reported.
  std::atomic<int> turns{0};
  for (int i = 1; i <= 4; ++i) {
    entity.clock().call_after(i * 10ms, [&] { ++turns; });
  }
  REQUIRE(test::eventually([&] { return turns == 4; }));
  CHECK(pipe.is_empty());
  released = true;
  released.notify_all();
  CHECK(pipe.brings(3));
}

TEST_CASE("Who is not asked for progress reports none") {
  Pipe pipe;
  Entity entity({.name = "a", .vendor = dds::load_vendor("loopback")});
  report_ready();
  pipe.clear();
  const ProgressReport report(entity, 0s);
  std::atomic<bool> passed{false};
  entity.check_progress([&](const std::string& stuck) { passed = stuck.empty(); });
  REQUIRE(test::eventually([&] { return passed.load(); }));
  CHECK(pipe.is_empty());
}
