#include "same_host/led_links.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "link_pair.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::LinkPair;
using Looked = ReceivedLink::Looked;

namespace {

/// Counts what comes, and does as a call does that takes long.
struct Counter final : Inbox {
  void on_begin(Link&) override { ++begun; }
  void on_message(Link&, std::span<const std::byte>, calls::Turn& turn) override {
    ++messages;
    if (long_call) left = turn.leave();
    if (long_call) long_call();
  }
  void on_end(Link&) override { ++ended; }

  int begun = 0;
  int messages = 0;
  int ended = 0;
  bool left = false;
  std::function<void()> long_call;
};

/// What a receiver has, on this thread alone.
struct Leader {
  std::shared_ptr<ReceivedLink> add(const LinkPair& connection) {
    const std::uint64_t id = ++last_id;
    const auto added = std::make_shared<ReceivedLink>(connection.server, inbox, id,
                                                      Duration::zero(), unfinished, news);
    news->doorbells.add(connection.server->doorbells().in, id);
    links.take_in({added});
    return added;
  }
  Looked look() { return links.look(taker); }

  Counter inbox;
  std::uint64_t last_id = 0;
  std::shared_ptr<Unfinished> unfinished = std::make_shared<Unfinished>(64 << 10);
  std::shared_ptr<ReceiverNews> news = std::make_shared<ReceiverNews>();
  LedLinks links{news, Duration::zero()};
  Lead lead;
  Taker taker{Taker::Who::Consumer, &lead, [this] { links.wake_peers(); }};
};

}  // namespace

TEST_CASE("a new link begins at once, and is looked at while it brings something") {
  Leader leader;
  const LinkPair connection;
  leader.add(connection);
  CHECK(leader.look() == Looked::Something);
  CHECK(leader.inbox.begun == 1);
  CHECK(leader.look() == Looked::Nothing);
  connection.request();
  connection.request();
  CHECK(leader.look() == Looked::Something);
  CHECK(leader.inbox.messages == 2);
  CHECK(leader.look() == Looked::Nothing);
}

TEST_CASE("a link that has brought nothing is not looked at until its doorbell rings") {
  Leader leader;
  const LinkPair quiet;
  leader.add(quiet);
  leader.look();
  leader.links.listen();  // a new doorbell has rung once
  leader.news->doorbells.call();
  leader.links.await();  // as it would sleep, the link's writer is to ring
  quiet.request();
  CHECK(leader.look() == Looked::Nothing);
  CHECK(leader.links.listen());
  CHECK(leader.look() == Looked::Something);
  CHECK(leader.inbox.messages == 1);
}

TEST_CASE("what comes for a caller is left to it until it is taken back") {
  Leader leader;
  const LinkPair connection;
  const auto link = leader.add(connection);
  leader.look();
  link->lend();
  leader.links.listen();  // a new doorbell has rung once
  leader.news->doorbells.call();
  leader.links.await();  // as it would sleep, the link's writer is to ring
  connection.request();
  CHECK(leader.look() == Looked::Nothing);
  link->take_back();
  CHECK(leader.news->changed);
  CHECK(leader.look() == Looked::Nothing);
  leader.links.take_in({});
  CHECK(leader.look() == Looked::Something);
  CHECK(leader.inbox.messages == 1);
}

TEST_CASE("a thread whose call takes long goes on if nobody leads meanwhile, or else is replaced") {
  Leader leader;
  const LinkPair connection;
  leader.add(connection);
  REQUIRE(leader.lead.take());
  const bool another_leads = GENERATE(false, true);
  leader.inbox.long_call = [&] {
    if (another_leads) leader.lead.take();
  };
  connection.request();
  CHECK(leader.look() == (another_leads ? Looked::Replaced : Looked::Something));
  CHECK(leader.inbox.left);
}

TEST_CASE("a link ends after what came before, and a removed one brings nothing more") {
  Leader leader;
  const LinkPair ending, removed;
  leader.add(ending);
  const auto link = leader.add(removed);
  leader.look();
  ending.request();
  ending.server->close();
  removed.request();
  link->remove();
  while (leader.look() == Looked::Something) {
  }
  CHECK(leader.inbox.messages == 1);
  CHECK(leader.inbox.ended == 1);
}
