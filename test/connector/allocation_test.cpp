#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>
#include <new>

#include "echo_service.hpp"
#include "skein/entity.hpp"
#include "skein/loopback.hpp"

namespace {

std::atomic<std::size_t> allocations{0};  // of all threads

}  // namespace

void* operator new(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* const memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  const auto step = static_cast<std::size_t>(alignment);
  if (void* const memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

using namespace skein;
using skein::test::EchoService;
using ::test::Echo;

constexpr std::size_t kCalls = 200;

/// One entity that serves and one that calls, of one process or of two. Their time stands still, so
/// that nothing but calls allocates: no lease, no statistics.
class Pair {
 public:
  explicit Pair(bool one_process, CallThread thread = CallThread::Own) {
    server_ = make("server", std::make_shared<Process>(clock_));
    server_->provide<Echo>(std::make_shared<EchoService>(), {.thread = thread});
    client_ = make("client",
                   one_process ? server_->options().process : std::make_shared<Process>(clock_));
    echo.emplace(client_->connect<Echo>());
  }
  ~Pair() { echo.reset(); }

  std::optional<Echo::Proxy> echo{};

 private:
  std::unique_ptr<Entity> make(const std::string& name, std::shared_ptr<Process> process) {
    EntityOptions options;
    options.name = name;
    options.vendor = network_.vendor();
    options.process = std::move(process);
    return std::make_unique<Entity>(std::move(options));
  }

  std::shared_ptr<ManualClock> clock_ = std::make_shared<ManualClock>();
  dds::LoopbackNetwork network_{*clock_};
  std::unique_ptr<Entity> server_;
  std::unique_ptr<Entity> client_;
};

/// The fewest blocks that all threads took from the heap in any of several rounds of `call`: in the
/// first ones the memory that is kept grows to what ever was needed at once, which is for the
/// scheduler to say.
std::size_t allocations_of(const std::function<void()>& call) {
  constexpr int kRounds = 50;
  std::size_t fewest = SIZE_MAX;
  for (int round = 0; round < kRounds && fewest > 0; ++round) {
    const std::size_t before = allocations;
    for (std::size_t i = 0; i < kCalls; ++i) call();
    fewest = std::min<std::size_t>(fewest, allocations - before);
  }
  return fewest;
}

std::function<void()> blocking(Echo::Proxy& echo) {
  return [&echo] {
    std::int32_t remainder = 0;
    echo.divide(17, 5, remainder);
  };
}

std::function<void()> asynchronous(Echo::Proxy& echo) {
  return [&echo] { echo.async_divide(17, 5).get(); };
}

}  // namespace

TEST_CASE("a steady call allocates nothing, within the process or over loopback") {
  const bool one_process = GENERATE(true, false);
  CAPTURE(one_process);
  Pair pair(one_process, GENERATE(CallThread::Own, CallThread::Caller));
  CHECK(allocations_of(blocking(*pair.echo)) == 0);
  CHECK(allocations_of(asynchronous(*pair.echo)) == 0);
}

TEST_CASE("steady calls that wait in line allocate nothing") {
  const bool one_process = GENERATE(true, false);
  CAPTURE(one_process);
  constexpr std::size_t kAtOnce = 16;
  Pair pair(one_process);
  CHECK(allocations_of([&] {
          std::array<std::optional<Call<::test::Echo_divide_Out>>, kAtOnce> calls;
          for (auto& call : calls) call.emplace(pair.echo->async_divide(17, 5));
          for (auto& call : calls) call->get();
        }) == 0);
}
