#include "rpc/service/circular_wait.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "rpc/service/invocation.hpp"
#include "rpc/service/service_owner.hpp"
#include "skein/error.hpp"

using namespace skein;

namespace {

Guid named(char name) {
  Guid guid;
  guid.bytes[0] = static_cast<std::uint8_t>(name);
  return guid;
}

void refuse(std::size_t threads, const rpc::Invocation& invocation) {
  const auto name_of = [](const Guid& strand) -> std::string {
    return strand == named('s') ? "Echo of server" : strand == named('m') ? "Relay of middle" : "";
  };
  const rpc::ServiceOwner owner({}, name_of, {});
  rpc::CircularWait{"Echo", named('s'), threads}.refuse(invocation, owner);
}

void refuse(std::size_t threads, std::vector<Guid> chain) {
  rpc::Invocation invocation;
  invocation.chain = std::move(chain);
  refuse(threads, invocation);
}

}  // namespace

TEST_CASE("a call that all threads of a service wait for is refused with the circle's names") {
  const Guid s = named('s');
  const Guid m = named('m');
  const Guid stranger = named('x');
  CHECK_NOTHROW(refuse(2, {s}));
  CHECK_NOTHROW(refuse(2, {m, s, m}));
  CHECK_THROWS_AS(refuse(1, {s}), Unavailable);
  CHECK_THROWS_WITH(refuse(2, {m, s, m, stranger, s}),
                    Catch::Contains("the call to Echo would wait for itself") &&
                        Catch::Contains("(Echo of server -> Relay of middle -> service " +
                                        stranger.hex() + " -> Echo of server -> the first again)"));
}

TEST_CASE("the thread that makes the call counts as blocked, if it runs a call of the service") {
  ManualClock clock;
  const CallContext context(clock, Instant::max(), Guid(), {nullptr, {}, named('s')}, nullptr,
                            nullptr);
  rpc::Invocation invocation;
  invocation.outer = &context;
  CHECK_THROWS_AS(refuse(1, invocation), Unavailable);
  CHECK_NOTHROW(refuse(2, invocation));
}
