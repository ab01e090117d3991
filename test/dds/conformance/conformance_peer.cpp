// The other process of the suite: a participant with one endpoint, which obeys the lines that it
// reads and ends with its standard input.
#include <cstdio>
#include <iostream>

#include "test/tools/stepped_clock.hpp"
#include "wire.hpp"

using namespace skein::dds;
using namespace skein::dds::conformance;
using namespace std::chrono_literals;

const Pairing skein::dds::conformance::kPairing{};

namespace {

void say(const std::string& line) { std::cout << line << std::endl; }

int write_on_demand(Participant& participant, std::chrono::milliseconds liveliness) {
  Qos qos = last_state();
  qos.liveliness_lease = liveliness;
  Outbox outbox(participant, keyed(), qos);
  outbox.writer().write(make_number(0), make_key(1));
  say("writer " + outbox.writer().guid().hex());
  std::uint32_t next = 1;
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "step back") {
      skein::test::step_wall_clock(-1h);
      say("stepped back");
      continue;
    }
    outbox.writer().write(make_number(next), make_key(1));
    say("wrote " + std::to_string(next++));
  }
  return 0;
}

int count_on_demand(Participant& participant) {
  Inbox inbox(participant, keyless(), keep_all());
  say("reader " + inbox.reader().guid().hex());
  for (std::string line; std::getline(std::cin, line);)
    say("count " + std::to_string(inbox.count()));
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr, "usage: %s write|write_rarely|read VENDOR DOMAIN LEASE_MS\n",
                 arguments[0]);
    return 2;
  }
  const std::string role(arguments[1]);
  const auto participant =
      make_participant(arguments[2], static_cast<std::uint32_t>(std::stoul(arguments[3])),
                       std::chrono::milliseconds(std::stoul(arguments[4])));
  if (role == "write") return write_on_demand(*participant, 300ms);
  if (role == "write_rarely") return write_on_demand(*participant, 60s);
  return count_on_demand(*participant);
}
