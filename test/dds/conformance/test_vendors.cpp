#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>

#include "dds/port/keyed_queue.hpp"
#include "dds/port/port.hpp"
#include "dds/port/sample_format.hpp"
#include "dds/port/topic_table.hpp"
#include "dds/port/vendor_names.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace skein::dds;
using Catch::Contains;

TEST_CASE("an unknown vendor is refused with the known ones and the nearest") {
  CHECK_THROWS_WITH(load_vendor("fastdss"), Contains("did you mean 'fastdds'") &&
                                                Contains("cyclonedds") && Contains("loopback"));
  CHECK_THROWS_AS(load_vendor(""), InvalidArgument);
}

TEST_CASE("the library knows the vendors that the build knows, and loopback") {
  std::string networked;
  for (const std::string& name : networked_vendors()) {
    networked += (networked.empty() ? "" : ",") + name;
  }
  CHECK(networked == SKEIN_VENDORS);
  auto all = networked_vendors();
  all.push_back(kLoopback);
  CHECK(vendor_names() == all);
  for (const std::string& name : shared_memory_vendors()) {
    CHECK(std::count(all.begin(), all.end(), name) == 1);
  }
}

TEST_CASE("alternatives are listed as people write them") {
  CHECK(alternatives({}) == "");
  CHECK(alternatives({"a"}) == "a");
  CHECK(alternatives({"a", "b"}) == "a or b");
  CHECK(alternatives({"a", "b", "c"}) == "a, b or c");
}

TEST_CASE("loopback is always there, and one network for the process") {
  const auto one = load_vendor("loopback")->create_participant({});
  const auto other = load_vendor("loopback")->create_participant({});
  CHECK(load_vendor("loopback")->name() == "loopback");
  CHECK(one->guid() != other->guid());
}

TEST_CASE("padding comes off again, and its mark with it") {
  for (std::size_t size = 4; size < 20; ++size) {
    std::vector<std::byte> sample(size, std::byte{0x5A});
    sample[3] = std::byte{0};
    std::vector<std::byte> sent(padded(size));
    copy_padded(sample, sent.data());
    const auto received = without_padding(sent.data(), sent.size());
    INFO("size " << size);
    CHECK((std::vector(received.begin(), received.end()) == sample));
  }
}

TEST_CASE("a mark of more padding than there is takes nothing away") {
  std::byte message[] = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{3}};
  CHECK(without_padding(message, 4).size() == 4);
  std::byte odd[] = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{3}, std::byte{9}};
  CHECK(without_padding(odd, 5).size() == 5);
}

TEST_CASE("only the representation of the type is taken, without XCDR1's parameter lists") {
  const auto has = [](DataRepresentation representation, std::initializer_list<int> bytes) {
    std::vector<std::byte> message;
    for (const int byte : bytes) message.push_back(static_cast<std::byte>(byte));
    return has_representation(message, representation);
  };
  const auto accepted = [&](std::initializer_list<int> bytes) {
    return has(DataRepresentation::Xcdr1, bytes);
  };
  for (int kind = 0; kind <= 12; ++kind) {
    CHECK(has(DataRepresentation::Xcdr2, {0, kind, 0, 0}) == (kind >= 6 && kind <= 11));
  }
  CHECK_FALSE(accepted({0, 7, 0, 0}));
  CHECK(accepted({0, 1, 0, 0}));
  CHECK(accepted({0, 0, 0, 0, 1}));
  CHECK_FALSE(accepted({}));
  CHECK_FALSE(accepted({0, 1, 0}));
  CHECK_FALSE(accepted({0, 2, 0, 0}));
  CHECK_FALSE(accepted({0, 3, 0, 0}));
  CHECK_FALSE(accepted({1, 1, 0, 0}));
}

TEST_CASE("a keyed queue keeps the newest of each key, in order of arrival") {
  KeyedQueue<int> queue(2);
  Guid one;
  Guid two;
  two.bytes[0] = 1;
  queue.push(two, 100);
  for (int i = 0; i < 1000; ++i) queue.push(one, i);
  CHECK(queue.size() == 3);
  CHECK(queue.pop() == 100);
  CHECK(queue.pop() == 998);
  queue.push(one, 1000);
  queue.push(one, 1001);
  CHECK(queue.pop() == 1000);
  CHECK(queue.pop() == 1001);
  CHECK_FALSE(queue.pop());
  queue.push(one, 1);
  queue.push(two, 2);
  queue.erase(one);
  CHECK(queue.pop() == 2);
  CHECK(queue.empty());
}

TEST_CASE("a keyed queue with a capacity gives up its oldest item, of whichever key") {
  KeyedQueue<int> queue(2, 3);
  Guid one;
  Guid two;
  two.bytes[0] = 1;
  CHECK_FALSE(queue.push(one, 1));
  CHECK_FALSE(queue.push(two, 2));
  CHECK_FALSE(queue.push(two, 3));
  CHECK(queue.push(one, 4));
  CHECK(queue.push(two, 5));
  CHECK(queue.size() == 3);
  CHECK(queue.pop() == 3);
  CHECK(queue.pop() == 4);
  CHECK(queue.pop() == 5);
}

TEST_CASE("a participant destroyed before its endpoints ends the program, and names a topic") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGABRT, SIG_DFL);
    dup2(ends[1], STDERR_FILENO);
    TopicTable<int> topics;
    topics.acquire({"radar", "Echo"}, [] { return 0; });
    topics.expect_unused("alpha");
    _exit(0);
  }
  close(ends[1]);
  char said[500] = {};
  CHECK(read(ends[0], said, sizeof said - 1) > 0);
  close(ends[0]);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK((WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT));
  CHECK_THAT(said, Contains("'alpha'") && Contains("'radar'"));
}
