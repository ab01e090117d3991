// A process with a participant, a reader and a writer, which writes until its standard input ends:
// the one that the churn stops and kills.
#include <cstdio>
#include <iostream>
#include <thread>

#include "churn.hpp"

using namespace skein::test;

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: %s VENDOR LEASE_MS\n", arguments[0]);
    return 2;
  }
  const auto vendor = skein::dds::load_vendor(arguments[1]);
  const auto participant =
      churn_participant(*vendor, std::chrono::milliseconds(std::stoul(arguments[2])));
  std::atomic<bool> running{true};
  std::jthread writing([&] {
    std::mt19937 random(std::random_device{}());
    std::atomic<std::uint64_t> received{0};
    while (running) {
      const auto of = ChurnTopic::any(random);
      const auto reader = churn_reader(*participant, of, received);
      const auto writer = churn_writer(*participant, of);
      for (int i = 0; i < 20 && running; ++i) {
        churn_write(*writer, of, random);
        let_live(std::chrono::milliseconds(5));
      }
    }
  });
  std::cout << "ready" << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
  }
  running = false;
  return 0;
}
