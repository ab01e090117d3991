#include <catch2/catch.hpp>
#include <csignal>

#include "test/tools/child_process.hpp"
#include "wire.hpp"

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::conformance;
using skein::test::ChildProcess;
using skein::test::eventually;
using namespace std::chrono_literals;

namespace {

ChildProcess start(const std::string& role, std::uint32_t domain, const std::string& lease_ms) {
  const std::string& vendor = role == "read" ? kPairing.reading : kPairing.writing;
  return ChildProcess("skein_conformance_peer",
                      {.arguments = {role, vendor, std::to_string(domain), lease_ms}});
}

/// The GUID that the peer says first.
Guid endpoint(ChildProcess& peer) {
  const std::string line = peer.read();
  const auto guid = Guid::from_hex(line.substr(line.find(' ') + 1));
  REQUIRE(guid);
  return *guid;
}

Qos watched_state() {
  Qos qos = last_state();
  qos.liveliness_lease = 300ms;
  return qos;
}

using Events = std::vector<std::pair<Guid, bool>>;

bool told_last(const Events& events, const Guid& guid, bool what) {
  return !events.empty() && events.back() == std::pair{guid, what};
}

/// Whether it was told since there were so many events; it may have been taken back already.
bool told_since(std::size_t count, const Events& events, const Guid& guid, bool what) {
  return std::find(events.begin() + static_cast<std::ptrdiff_t>(count), events.end(),
                   std::pair{guid, what}) != events.end();
}

}  // namespace

TEST_CASE("a killed process loses its liveliness, then its place") {
  const std::uint32_t domain = fresh_domain();
  const auto participant = make_participant(kPairing.reading, domain);
  Inbox inbox(*participant, keyed(), watched_state());
  ChildProcess peer = start("write", domain, "1000");
  const Guid writer = endpoint(peer);
  REQUIRE(eventually([&] { return inbox.count() >= 1; }));
  CHECK(inbox.received()[0].writer == writer);
  peer.signal(SIGKILL);
  REQUIRE(eventually([&] { return told_last(inbox.liveliness(), writer, false); }));
  REQUIRE(eventually([&] { return told_last(inbox.matches(), writer, false); }));
  // The end brings no sample. A loaded machine may lose the peer before, and bring its state anew.
  for (const Received& sample : inbox.received()) {
    CHECK(sample.state == InstanceState::Alive);
    CHECK(to_number(sample.cdr) == 0);
  }
  CHECK(inbox.reader().matched_writers().empty());
}

TEST_CASE("a process that is stopped shortly is silent, and alive again when it writes") {
  const std::uint32_t domain = fresh_domain();
  const auto participant = make_participant(kPairing.reading, domain);
  Inbox inbox(*participant, keyed(), watched_state());
  ChildProcess peer = start("write", domain, "60000");
  const Guid writer = endpoint(peer);
  REQUIRE(eventually([&] { return inbox.count() == 1; }));
  peer.signal(SIGSTOP);
  REQUIRE(eventually([&] { return told_last(inbox.liveliness(), writer, false); }));
  CHECK(inbox.reader().matched_writers() == std::vector{writer});
  const std::size_t before = inbox.liveliness().size();
  peer.signal(SIGCONT);
  peer.send("write");
  REQUIRE(eventually([&] { return told_since(before, inbox.liveliness(), writer, true); }));
  REQUIRE(eventually([&] { return inbox.count() == 2; }));
}

TEST_CASE("a process that is stopped beyond its lease is found again, and heard") {
  const std::uint32_t domain = fresh_domain();
  const auto participant = make_participant(kPairing.reading, domain, 1s);
  Inbox inbox(*participant, keyed(), watched_state());
  ChildProcess peer = start("write", domain, "1000");
  const Guid writer = endpoint(peer);
  REQUIRE(eventually([&] { return inbox.count() >= 1; }));
  peer.signal(SIGSTOP);
  REQUIRE(eventually([&] { return told_last(inbox.matches(), writer, false); }));
  const std::size_t before = inbox.matches().size();
  peer.signal(SIGCONT);
  REQUIRE(eventually([&] { return told_since(before, inbox.matches(), writer, true); }));
  // A single sample may go down while only one side has forgotten the other (seen from Cyclone to
  // Fast DDS on a loaded machine): who keeps state writes it again.
  REQUIRE(eventually([&] {
    peer.send("write");
    peer.read();
    return to_number(inbox.received().back().cdr) > 0;
  }));
}

TEST_CASE("a process that ends in order is gone at once") {
  const std::uint32_t domain = fresh_domain();
  const auto participant = make_participant(kPairing.reading, domain, 60s);
  Inbox inbox(*participant, keyed(), last_state());
  ChildProcess peer = start("write_rarely", domain, "60000");
  const Guid writer = endpoint(peer);
  REQUIRE(eventually([&] { return inbox.count() == 1; }));
  CHECK(peer.finish() == 0);
  CHECK(eventually([&] { return told_last(inbox.matches(), writer, false); }));
  CHECK(inbox.liveliness().empty());
}

TEST_CASE("a process whose wall clock is set back stays known") {
  const std::uint32_t domain = fresh_domain();
  const auto participant = make_participant(kPairing.reading, domain);
  Inbox inbox(*participant, keyed(), last_state());
  ChildProcess peer = start("write_rarely", domain, "1000");
  const Guid writer = endpoint(peer);
  // Found before the step: whoever is found wakes the threads that wait.
  ChildProcess other = start("write_rarely", domain, "3000");
  const Guid others_writer = endpoint(other);
  REQUIRE(eventually([&] { return inbox.reader().matched_writers().size() == 2; }));
  peer.send("step back");
  REQUIRE(peer.read() == "stepped back");
  // It takes longer to miss this one.
  other.signal(SIGKILL);
  REQUIRE(eventually([&] { return told_since(0, inbox.matches(), others_writer, false); }));
  CHECK_FALSE(told_since(0, inbox.matches(), writer, false));
}

TEST_CASE("a stopped reader makes a bounded writer refuse, not hang, and nothing written is lost") {
  const std::uint32_t domain = fresh_domain();
  const auto participant = make_participant(kPairing.writing, domain, 60s);
  Qos qos = keep_all();
  qos.max_samples = 8;
  qos.max_blocking = 100ms;
  Outbox outbox(*participant, keyless(), qos);
  ChildProcess peer = start("read", domain, "60000");
  const Guid reader = endpoint(peer);
  REQUIRE(eventually([&] { return outbox.writer().matched_readers() == std::vector{reader}; }));
  // The reader must have matched too, or the first samples are not for it.
  std::uint32_t written = 0;
  REQUIRE(eventually([&] {
    outbox.writer().write(make_number(0));
    ++written;
    peer.send("count");
    return peer.read() != "count 0";
  }));
  REQUIRE(outbox.writer().wait_for_acknowledgments(10s));
  peer.send("count");
  const std::string before = peer.read();
  const std::uint32_t heard = static_cast<std::uint32_t>(std::stoul(before.substr(6)));

  peer.signal(SIGSTOP);
  std::uint32_t accepted = 0;
  bool refused = false;
  for (int i = 0; i < 1000 && !refused; ++i) {
    try {
      outbox.writer().write(make_number(7));
      ++accepted;
    } catch (const Overloaded&) {
      refused = true;
    }
  }
  CHECK(refused);
  CHECK(accepted <= qos.max_samples);
  CHECK_FALSE(outbox.writer().wait_for_acknowledgments(20ms));
  peer.signal(SIGCONT);
  CHECK(outbox.writer().wait_for_acknowledgments(10s));
  CHECK(eventually([&] {
    peer.send("count");
    return peer.read() == "count " + std::to_string(heard + accepted);
  }));
  CHECK_NOTHROW(outbox.writer().write(make_number(8)));
}

TEST_CASE("one stopped reader does not keep samples from the others") {
  const std::uint32_t domain = fresh_domain();
  const auto writing = make_participant(kPairing.writing, domain, 60s);
  const auto reading = make_participant(kPairing.reading, domain, 60s);
  Outbox outbox(*writing, keyless(), keep_all());
  Inbox inbox(*reading, keyless(), keep_all());
  ChildProcess peer = start("read", domain, "60000");
  endpoint(peer);
  REQUIRE(matched(outbox, inbox));
  REQUIRE(eventually([&] { return outbox.writer().matched_readers().size() == 2; }));
  peer.signal(SIGSTOP);
  for (std::uint32_t i = 0; i < 200; ++i) outbox.writer().write(make_number(i));
  CHECK(eventually([&] { return inbox.count() == 200; }));
}

TEST_CASE("more participants than the host may hold are refused, with a remedy") {
  ParticipantOptions options;
  options.domain = fresh_domain();
  options.network.max_participants = 2;
  const auto vendor = load_vendor(kPairing.writing);
  const auto first = vendor->create_participant(options);
  const auto second = vendor->create_participant(options);
  CHECK_THROWS_AS(vendor->create_participant(options), Unavailable);
}
