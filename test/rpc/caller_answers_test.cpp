#include "rpc/client/caller_answers.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <memory>

using namespace skein;
using namespace skein::rpc;

namespace {

/// `bring` says what comes while a thread takes it.
struct Delivery final : calls::CallerDelivery {
  void lend() override { lent = true; }
  void pause() override { paused = true; }
  void take_back() override { lent = false; }
  void deliver_until(const std::function<bool()>& over) override {
    ++delivered;
    bring();
    ended = over();
  }
  void wake() override { ++woken; }

  std::function<void()> bring = [] {};
  bool lent = false;
  bool paused = false;
  int delivered = 0;
  int woken = 0;
  bool ended = false;
};

struct Connection {
  const std::shared_ptr<Delivery> delivery = std::make_shared<Delivery>();
  CallerAnswers answers{delivery};
  std::atomic<bool> finished{false};
};

}  // namespace

TEST_CASE("who waits takes answers, as long as calls are under way that nobody else waits for") {
  Connection connection;
  connection.answers.begin(false);
  connection.answers.begin(false);
  CHECK_FALSE(connection.delivery->lent);
  connection.delivery->bring = [&] {
    CHECK(connection.delivery->lent);
    connection.finished = true;
    connection.answers.end();
  };
  connection.answers.take_until(connection.finished);
  CHECK(connection.delivery->delivered == 1);
  CHECK(connection.delivery->ended);
  CHECK(connection.delivery->lent);
  CHECK(connection.delivery->paused);
  SECTION("until they have ended") { connection.answers.end(); }
  SECTION("until one is awaited otherwise") { connection.answers.attend(); }
  SECTION("until they are handed over") { connection.answers.hand_over(); }
  CHECK_FALSE(connection.delivery->lent);
}

TEST_CASE("a thread that will wait for the answer at once takes it from the beginning") {
  Connection connection;
  const bool blocking = GENERATE(false, true);
  connection.answers.begin(blocking);
  CHECK(connection.delivery->lent == blocking);
  connection.answers.end();  // before anybody has waited
  CHECK_FALSE(connection.delivery->lent);
  connection.finished = true;
  connection.answers.take_until(connection.finished);
  CHECK_FALSE(connection.delivery->lent);
}

TEST_CASE("nobody who waits takes answers while another call's end is awaited otherwise") {
  Connection connection;
  connection.answers.attend();
  connection.answers.attend();
  connection.answers.leave();
  connection.answers.begin(true);
  connection.answers.take_until(connection.finished);
  CHECK(connection.delivery->delivered == 0);
  CHECK_FALSE(connection.delivery->lent);
  connection.answers.leave();
  connection.answers.take_until(connection.finished);
  CHECK(connection.delivery->lent);
  CHECK(connection.delivery->delivered == 1);
}

TEST_CASE("of two threads that wait one takes the answers, and is woken") {
  Connection connection;
  connection.delivery->bring = [&] { connection.answers.take_until(connection.finished); };
  connection.answers.take_until(connection.finished);
  CHECK(connection.delivery->delivered == 1);
  connection.delivery->bring = [] {};
  connection.answers.take_until(connection.finished);
  CHECK(connection.delivery->delivered == 2);
  connection.answers.wake();
  CHECK(connection.delivery->woken == 1);
}
