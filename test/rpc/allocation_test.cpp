#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>

#include "../connector/echo_service.hpp"
#include "skein/dds/loopback.hpp"
#include "skein/entity/entity.hpp"

namespace {

thread_local std::size_t allocations = 0;

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

using namespace skein;
using skein::test::EchoService;

/// Blocks that the calling thread allocates in `count` calls of a type of fixed size.
std::size_t allocations_of(::test::Echo::Proxy& proxy, std::size_t count) {
  std::int32_t remainder = 0;
  const std::size_t before = allocations;
  for (std::size_t i = 0; i < count; ++i) proxy.divide(17, 5, remainder);
  return allocations - before;
}

}  // namespace

TEST_CASE("a call within the process allocates nothing") {
  constexpr std::size_t kCalls = 100;
  SystemClock clock;
  dds::LoopbackNetwork network(clock);
  EntityOptions options;
  options.name = "both";
  options.vendor = network.vendor();
  Entity entity(options);
  entity.provide<::test::Echo>(std::make_shared<EchoService>());
  auto proxy = entity.connect<::test::Echo>();
  allocations_of(proxy, kCalls);
  CHECK(allocations_of(proxy, kCalls) == 0);
}
