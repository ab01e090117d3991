#include "connector/provider_pool.hpp"

#include <catch2/catch.hpp>

#include "connector/reconnector.hpp"
#include "fake_provider.hpp"
#include "test/brokerless_discovery/descriptions.hpp"

using namespace skein;
using namespace skein::connector;
using namespace skein::test;

namespace {

/// Connections to providers 1, 2 and 3, of which the pool has the first.
struct Connections {
  Connections() {
    for (std::uint8_t number : {1, 2, 3}) {
      channels.push_back(std::make_shared<FakeChannel>(clock, executor));
      all.push_back({guid(number), channels.back(), channels.back()->suspect});
    }
    pool.emplace(all[0]);
  }
  bool is_ready(std::size_t index, const ProviderQuery& wanted = {}) {
    const auto ready = pool->ready(wanted);
    return ready && ready->channel == channels[index];
  }
  Guid acquire(const ProviderQuery& wanted) {
    Reconnector reconnector(*pool, [&](const ProviderQuery& query) -> ProviderConnection {
      asked = query;
      if (refuses) throw Overloaded("full");
      if (none) throw NoProvider("nobody is left");
      return all[1];
    });
    return reconnector.acquire(wanted).provider;
  }

  ManualClock clock;
  ManualExecutor executor;
  std::vector<std::shared_ptr<FakeChannel>> channels;
  std::vector<ProviderConnection> all;
  std::optional<ProviderPool> pool;
  std::optional<ProviderQuery> asked;
  bool none = false;
  bool refuses = false;
};

}  // namespace

TEST_CASE_METHOD(Connections, "a lost or suspect main connection is replaced by the new one") {
  GENERATE_COPY(0, 1) == 0 ? channels[0]->disconnect() : channels[0]->suspect->store(true);
  CHECK_FALSE(pool->ready({}));
  pool->keep(all[1]);
  CHECK(is_ready(1));
  CHECK(pool->main().provider == guid(2));
}

TEST_CASE_METHOD(Connections,
                 "a connection beside one that stands waits for a call that needs it") {
  pool->keep(all[1]);
  CHECK(is_ready(0));
  CHECK(is_ready(1, {{}, {}, {guid(1)}}));
  CHECK_FALSE(pool->ready({{}, {}, {guid(1), guid(2)}}));
  CHECK(pool->main().provider == guid(1));
  channels[0]->disconnect();
  CHECK(is_ready(1));
  CHECK(pool->main().provider == guid(2));
}

TEST_CASE_METHOD(Connections, "a closed pool gives all it has, and ends what it gets later") {
  pool->keep(all[1]);
  CHECK(pool->connected());
  CHECK(pool->close().size() == 2);
  CHECK(pool->closed());
  CHECK_FALSE(pool->connected());
  CHECK_THROWS_AS(pool->refuse_if_closed(), Unavailable);
  CHECK(is_ready(0, {{}, {}, {guid(1)}}));
  pool->keep(all[2]);
  CHECK_FALSE(channels[2]->connected());
}

TEST_CASE_METHOD(Connections, "nothing is opened while a connection suits") {
  CHECK(acquire({}) == guid(1));
  CHECK_FALSE(asked);
  CHECK(acquire({{}, {}, {guid(1)}}) == guid(2));
  CHECK(asked->wait);
  asked.reset();
  CHECK(acquire({{}, {}, {guid(1)}}) == guid(2));
  CHECK_FALSE(asked);
}

TEST_CASE_METHOD(Connections, "a provider that was lost is asked last") {
  channels[0]->disconnect();
  CHECK(acquire({}) == guid(2));
  CHECK(asked->last == std::vector{guid(1)});
}

TEST_CASE_METHOD(Connections, "a suspect provider is better than none, and nobody is waited for") {
  *channels[0]->suspect = true;
  (GENERATE(false, true) ? none : refuses) = true;
  CHECK(acquire({}) == guid(1));
  CHECK_FALSE(asked->wait);
}

TEST_CASE_METHOD(Connections, "only a call that may wait is told that waiting helps") {
  channels[0]->disconnect();
  none = true;
  CHECK_THROWS_AS(acquire({}), NoProvider);
  ProviderQuery wanted;
  wanted.wait = false;
  try {
    acquire(wanted);
    FAIL("it was connected to nobody");
  } catch (const NoProvider&) {
    FAIL("it may not wait");
  } catch (const Unavailable& error) {
    CHECK(error.what() == std::string("nobody is left"));
  }
}
