#include "dds/loopback/unacknowledged.hpp"

#include <catch2/catch.hpp>

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::loopback;

namespace {

struct Kept : Unacknowledged {
  void write(std::uint64_t sequence, std::uint8_t key = 0,
             std::optional<std::uint32_t> depth = {}) {
    Message message{{}, {}, InstanceState::Alive, {}, {}, sequence};
    message.key.bytes[0] = key;
    add(std::make_shared<const Message>(std::move(message)), depth);
  }
  std::vector<std::uint64_t> pop_all() {
    std::vector<std::uint64_t> sequences;
    while (const MessagePtr message = pop_arrived()) sequences.push_back(message->sequence);
    return sequences;
  }
  std::vector<std::uint64_t> kept() const {
    std::vector<std::uint64_t> sequences;
    for (const auto& [sequence, entry] : entries()) sequences.push_back(sequence);
    return sequences;
  }
  std::vector<std::uint64_t> all_lost() const {
    std::vector<std::uint64_t> sequences;
    for (const Entry& entry : lost()) sequences.push_back(entry.message->sequence);
    return sequences;
  }
};

using Sequences = std::vector<std::uint64_t>;

}  // namespace

TEST_CASE_METHOD(Kept, "a sample waits until all before it have arrived") {
  for (const std::uint64_t sequence : {1, 2, 3}) write(sequence);
  CHECK(arrived(2));
  CHECK(pop_all().empty());
  CHECK(arrived(1));
  CHECK(pop_all() == Sequences{1, 2});
  CHECK(kept() == Sequences{3});
}

TEST_CASE_METHOD(Kept, "a second copy of a sample that is no longer kept does not arrive") {
  write(1);
  CHECK(arrived(1));
  CHECK(pop_all() == Sequences{1});
  CHECK_FALSE(arrived(1));
}

TEST_CASE_METHOD(Kept, "lost is a sample that neither arrived nor has a copy in flight") {
  for (const std::uint64_t sequence : {1, 2, 3}) write(sequence);
  sent(1, 1, 0);
  sent(2, 1, 2);
  sent(3, 1, 0);
  arrived(3);
  CHECK(all_lost() == Sequences{1});
  landed(2);
  CHECK(all_lost() == Sequences{1});
  landed(2);
  CHECK(all_lost() == Sequences{1, 2});
}

TEST_CASE_METHOD(Kept, "a lost sample knows how often it was sent") {
  write(1);
  sent(1, 1, 0);
  sent(1, 2, 0);
  REQUIRE(lost().size() == 1);
  CHECK(lost().front().attempts == 2);
}

TEST_CASE_METHOD(Kept, "with a depth, a newer sample takes the place of its instance's oldest") {
  write(1, 7, 2);
  write(2, 8, 2);
  write(3, 7, 2);
  write(4, 7, 2);
  CHECK(kept() == Sequences{2, 3, 4});
}
