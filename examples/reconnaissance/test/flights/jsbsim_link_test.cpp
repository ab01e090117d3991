// JSBSim's protocol against others that speak it badly, and programs that are not what they should
// be: each ends in an error that says what is wrong, and soon.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "jsbsim/failure.hpp"
#include "jsbsim/flight.hpp"
#include "jsbsim/link.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace reconnaissance;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

constexpr auto kPatience = 200ms;
// Until an error comes, on a machine that does much else.
constexpr auto kSoon = 10s;

/// In place of JSBSim: says something when somebody connects, and does what the test says.
class Peer {
 public:
  using Behaviour = std::function<void(int connection)>;

  explicit Peer(Behaviour behave, const std::string& greeting = "Connected\r\nJSBSim> ")
      : listening_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    REQUIRE(bind(listening_, reinterpret_cast<sockaddr*>(&address), size) == 0);
    REQUIRE(listen(listening_, 1) == 0);
    REQUIRE(getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, behave = std::move(behave), greeting] {
      const int connection = accept(listening_, nullptr, nullptr);
      say(connection, greeting);
      behave(connection);
      // Until the other side has gone.
      while (read_some(connection) > 0) {
      }
      close(connection);
    });
  }
  ~Peer() {
    shutdown(listening_, SHUT_RDWR);
    thread_.join();
    close(listening_);
  }
  Peer(const Peer&) = delete;

  std::uint16_t port() const { return port_; }

  static void say(int connection, const std::string& text) {
    send(connection, text.data(), text.size(), MSG_NOSIGNAL);
  }
  static ssize_t read_some(int connection) {
    char buffer[4096];
    return recv(connection, buffer, sizeof buffer, 0);
  }

 private:
  int listening_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

/// One that answers the first request so.
Peer::Behaviour answering(const std::string& answer) {
  return [answer](int connection) {
    if (Peer::read_some(connection) > 0) Peer::say(connection, answer);
  };
}

bool is_there() { return true; }

/// What keeps a link from getting a property of such a peer; it is said soon.
std::string failure_with(Peer::Behaviour behave, const std::string& greeting = "JSBSim> ") {
  const auto began = std::chrono::steady_clock::now();
  std::string reason = "none";
  Peer peer(std::move(behave), greeting);
  try {
    JsbsimLink link(peer.port(), kPatience, is_there);
    link.get({"a", "b"});
  } catch (const JsbsimFailure& failure) {
    reason = failure.what();
  }
  CHECK(std::chrono::steady_clock::now() - began < kSoon);
  return reason;
}

/// A program that is a shell script, in a folder that goes with it.
class Program {
 public:
  explicit Program(const std::string& script) {
    folder_.write("program", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(file(), std::filesystem::perms(0755));
  }

  std::string file() const { return (folder_.path() / "program").string(); }

 private:
  TemporaryFolder folder_;
};

Aircraft standing() {
  Aircraft aircraft;
  aircraft.position.height_m = 180;
  aircraft.fuel_kg = 4;
  return aircraft;
}

std::string failure_of(const std::string& program) {
  const auto began = std::chrono::steady_clock::now();
  std::string reason = "none";
  JsbsimFlight flight({.program = program, .origin = {53.3, 27.4, 180}, .patience = kPatience});
  try {
    flight.place(standing());
  } catch (const JsbsimFailure& failure) {
    reason = failure.what();
  }
  CHECK(flight.pid() == -1);
  CHECK(std::chrono::steady_clock::now() - began < kSoon);
  return reason;
}

}  // namespace

TEST_CASE("a link takes numbers, one for each property, however they are cut into pieces") {
  Peer peer([](int connection) {
    if (Peer::read_some(connection) <= 0) return;
    for (const char* part : {"a =", "         0.25\r\nJSB", "Sim> b =   -1e-05\r\nJSBSim> "})
      Peer::say(connection, part);
  });
  JsbsimLink link(peer.port(), kSoon, is_there);
  CHECK(link.get({"a", "b"}) == std::vector<double>{0.25, -1e-5});
}

TEST_CASE("what a peer says instead of an answer is told, with the question") {
  CHECK(failure_with(answering("Unknown property\r\nJSBSim> ")) ==
        "JSBSim answers 'Unknown property' to 'get a'");
  CHECK(failure_with(answering("a = 1\r\nJSBSim> c = 2\r\nJSBSim> ")) ==
        "JSBSim answers 'c = 2' to 'get b'");
  CHECK(failure_with(answering("a = 1 2\r\nJSBSim> ")) == "JSBSim answers 'a = 1 2' to 'get a'");
  CHECK(failure_with(answering("a = \r\nJSBSim> ")) == "JSBSim answers 'a =' to 'get a'");
}

TEST_CASE("a number that is none is no answer") {
  for (const char* number : {"nan", "-nan", "inf", "1e999"})
    CHECK_THAT(failure_with(answering(std::string("a = ") + number + "\r\nJSBSim> ")),
               Contains("to 'get a'"));
}

TEST_CASE("garbage is shown in part, and nothing of it reaches a terminal") {
  const std::string garbage(100'000, '\x1b');
  const std::string reason = failure_with(answering(garbage));
  CHECK_THAT(reason, Contains("without an end"));
  CHECK(reason.size() < 200);
  CHECK(reason.find('\x1b') == std::string::npos);
}

TEST_CASE("a peer that is silent, stops in mid-answer, or leaves, is given up") {
  CHECK(failure_with([](int) {}, "") == "JSBSim has said nothing for 0.2 s");
  CHECK(failure_with([](int) {}) == "JSBSim has said nothing for 0.2 s");
  CHECK(failure_with(answering("a = 1\r\nJSBSim> b = ")) ==
        "JSBSim answers 'b = ' and does not go on");
  CHECK(failure_with([](int connection) {
          Peer::read_some(connection);
          shutdown(connection, SHUT_RDWR);
        }) == "JSBSim has closed the connection");
}

TEST_CASE("nobody who listens is awaited for a while, or until it is known that nobody will") {
  const auto link = [](bool there) {
    JsbsimLink(free_port(), kPatience, [there] { return there; });
  };
  CHECK_THROWS_WITH(link(true), "JSBSim does not listen");
  CHECK_THROWS_WITH(link(false), "JSBSim has ended before it listened");
}

TEST_CASE("a program that is not there is told with where to get it") {
  CHECK_THAT(failure_of("/nowhere/JSBSim"), Contains("there is no program /nowhere/JSBSim; Debian "
                                                     "has it in the package flightgear"));
}

TEST_CASE("a program that ends is told with what it wrote last") {
  const Program program("echo working >&2; echo 'no such aircraft' >&2; exit 3");
  CHECK(failure_of(program.file()) ==
        "JSBSim has ended before it listened (it has ended with 3, and wrote at last: no such "
        "aircraft)");
}

TEST_CASE("a program that dies of a signal is told with it") {
  const Program program("kill -FPE $$");
  CHECK_THAT(failure_of(program.file()), Contains("it has died of Floating point exception"));
}

TEST_CASE("a program that hangs is given up, and ended") {
  const Program program("exec tail -f /dev/null");
  CHECK(failure_of(program.file()) == "JSBSim does not listen (it runs)");
}

TEST_CASE("an aircraft with more fuel than its tank holds is refused") {
  JsbsimFlight flight({.origin = {53.3, 27.4, 180}});
  Aircraft heavy = standing();
  heavy.fuel_kg = 80;
  CHECK_THROWS_WITH(flight.place(heavy), "the tank of its aircraft holds 5 kg of fuel, and not 80");
}

TEST_CASE("who has been placed nowhere flies nowhere") {
  JsbsimFlight flight({.origin = {53.3, 27.4, 180}});
  CHECK_THROWS_AS(flight.advance({}, {}, 180), JsbsimFailure);
}
