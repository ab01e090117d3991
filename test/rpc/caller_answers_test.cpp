#include "rpc/client/caller_answers.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <memory>

using namespace skein;
using namespace skein::rpc;

namespace {

/// `bring` says what comes while a thread takes it.
struct Delivery final : dds::CallerDelivery {
  void lend() override { lent = true; }
  void take_back() override { lent = false; }
  void deliver_until(const std::function<bool()>& over) override {
    ++delivered;
    bring();
    ended = over();
  }
  void wake() override { ++woken; }

  std::function<void()> bring = [] {};
  bool lent = false;
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

TEST_CASE("who waits takes answers, and goes on doing so until others want them") {
  Connection connection;
  connection.delivery->bring = [&] {
    CHECK(connection.delivery->lent);
    connection.finished = true;
  };
  connection.answers.take_until(connection.finished);
  CHECK(connection.delivery->delivered == 1);
  CHECK(connection.delivery->ended);
  CHECK(connection.delivery->lent);
  connection.answers.attend();
  CHECK_FALSE(connection.delivery->lent);
}

TEST_CASE("nobody who waits takes answers while another call's end is awaited otherwise") {
  Connection connection;
  connection.answers.attend();
  connection.answers.attend();
  connection.answers.leave();
  connection.answers.take_until(connection.finished);
  connection.answers.expect();
  CHECK(connection.delivery->delivered == 0);
  CHECK_FALSE(connection.delivery->lent);
  connection.answers.leave();
  connection.answers.expect();
  CHECK(connection.delivery->lent);
  connection.answers.take_until(connection.finished);
  CHECK(connection.delivery->delivered == 1);
}

TEST_CASE("of two threads that wait one takes the answers") {
  Connection connection;
  connection.delivery->bring = [&] { connection.answers.take_until(connection.finished); };
  connection.answers.take_until(connection.finished);
  CHECK(connection.delivery->delivered == 1);
  connection.delivery->bring = [] {};
  connection.answers.take_until(connection.finished);
  CHECK(connection.delivery->delivered == 2);
}

TEST_CASE("a thread that takes answers is woken, and hands them over, through its connection") {
  Connection connection;
  connection.answers.wake();
  CHECK(connection.delivery->woken == 1);
  connection.answers.expect();
  connection.answers.hand_over();
  CHECK_FALSE(connection.delivery->lent);
}
