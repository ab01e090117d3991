#include "view/outbox.hpp"

#include <catch2/catch.hpp>

using namespace skein::view;

namespace {

Frame frame(const std::string& text, std::size_t size = 0) {
  return {true, text, std::make_shared<const std::string>(size, 'x')};
}

std::string heads(Outbox& outbox) {
  std::string all;
  while (const auto next = outbox.pop()) all += next->head;
  return all;
}

}  // namespace

TEST_CASE("What must arrive goes before samples, and each in its order") {
  Outbox outbox(1 << 20);
  outbox.push_sample(1, frame("a"));
  REQUIRE(outbox.push(frame("1")));
  outbox.push_sample(2, frame("b"));
  REQUIRE(outbox.push(frame("2")));
  CHECK(heads(outbox) == "12ab");
  CHECK(outbox.dropped() == 0);
}

TEST_CASE("Where samples find no room, the oldest go and are counted") {
  Outbox outbox(4000);
  for (const char* name : {"a", "b", "c", "d", "e"}) outbox.push_sample(1, frame(name, 1000));
  CHECK(outbox.dropped() == 2);
  CHECK(heads(outbox) == "cde");
}

TEST_CASE("A sample that has waited too long goes, where its subscription has a newer one") {
  using namespace std::chrono_literals;
  const Outbox::Time start{};
  Outbox outbox(1 << 20);
  outbox.push_sample(1, frame("a"), start);
  outbox.push_sample(2, frame("b"), start);
  outbox.push_sample(1, frame("c"), start + 1s);
  outbox.push_sample(1, frame("d"), start + 2s);
  const auto popped = [&](Outbox::Time now) {
    const auto next = outbox.pop(now);
    return next ? next->head : "";
  };
  CHECK(popped(start + 2500ms) == "b");
  CHECK(outbox.dropped() == 1);
  CHECK(popped(start + 2500ms) == "d");
  CHECK(outbox.dropped() == 2);
  outbox.push_sample(1, frame("e"), start + 3s);
  outbox.push_sample(1, frame("f"), start + 3s);
  CHECK(popped(start + 4s) == "e");
  CHECK(popped(start + 9s) == "f");
  CHECK(outbox.dropped() == 2);
}

TEST_CASE("A sample that is larger than the queue waits alone") {
  Outbox outbox(1000);
  outbox.push_sample(1, frame("small"));
  outbox.push_sample(1, frame("large", 5000));
  CHECK(outbox.dropped() == 1);
  CHECK(heads(outbox) == "large");
  outbox.push_sample(1, frame("small"));
  CHECK(heads(outbox) == "small");
}

TEST_CASE("Samples never take the room of what must arrive, which is refused where it has none") {
  Outbox outbox(2000);
  for (int i = 0; i < 10; ++i) outbox.push_sample(1, frame("s", 500));
  CHECK(outbox.push(frame("1", 1500)));
  CHECK_FALSE(outbox.push(frame("2", 1500)));
  REQUIRE(outbox.pop());
  CHECK(outbox.push(frame("3", 1500)));
}

TEST_CASE(
    "The samples of a subscription that has ended are not sent, and do not count as dropped") {
  Outbox outbox(4000);
  outbox.push_sample(1, frame("a", 1000));
  outbox.push_sample(2, frame("b", 1000));
  outbox.push_sample(1, frame("c", 1000));
  outbox.forget(1);
  outbox.push_sample(2, frame("d", 1000));
  outbox.push_sample(2, frame("e", 1000));
  CHECK(outbox.dropped() == 0);
  CHECK(heads(outbox) == "bde");
}
