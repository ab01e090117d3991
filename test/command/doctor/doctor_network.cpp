// What the doctor concludes about the network, of machines that do not exist.
#include "machines.hpp"

using namespace skein::command::doctor;
using Catch::Contains;
using skein::test::only;
using skein::test::sound_machine;

namespace {

Purpose on_eth0() {
  Purpose purpose;
  purpose.interfaces = {"eth0"};
  return purpose;
}

UdpSocket socket_of(std::uint16_t port, int pid, const std::string& name,
                    std::uint64_t dropped = 0) {
  return {port, dropped, {pid, name}};
}

}  // namespace

TEST_CASE("a sound machine has nothing wrong, and each thing that was looked at is told") {
  const Symptoms symptoms = diagnose(on_eth0(), sound_machine());
  CHECK(worst_of(symptoms) == Severity::Fine);
  for (const char* about : {"loopback", "interface", "buffers", "domain", "firewall", "fastdds",
                            "cyclonedds", "clock", "shared memory", "limits"})
    CHECK(only(symptoms, about).severity == Severity::Fine);
}

TEST_CASE("whatever is wrong has a cause, and all but notes a remedy") {
  Facts facts;  // of a machine that has nothing
  facts.vendors = {{"fastdds", "no such file", "", "", {"2.9.1"}}};
  facts.limits = {64, 0, 0};
  Purpose purpose = on_eth0();
  purpose.priority = 50;
  purpose.locks_memory = true;
  for (const Symptom& symptom : diagnose(purpose, facts)) {
    CAPTURE(symptom.about, symptom.cause);
    CHECK(!symptom.cause.empty());
    if (symptom.severity >= Severity::Warning) CHECK(!symptom.remedy.empty());
    if (symptom.severity == Severity::Fine) CHECK(symptom.remedy.empty());
  }
}

TEST_CASE("without loopback, peers of one host do not meet") {
  Facts facts = sound_machine();
  facts.interfaces[0].up = false;
  Symptom symptom = only(diagnose_network({}, facts), "loopback");
  CHECK(symptom.severity == Severity::Error);
  CHECK(symptom.remedy == "sudo ip link set lo up");
  facts.interfaces.erase(facts.interfaces.begin());
  symptom = only(diagnose_network({}, facts), "loopback");
  CHECK(symptom.severity == Severity::Error);
  CHECK_THAT(symptom.cause, Contains("no interface has 127.0.0.1"));
}

TEST_CASE("an interface that is not there is told with the nearest and with those that are") {
  Purpose purpose;
  purpose.interfaces = {"eth1"};
  const Symptom symptom = only(diagnose_network(purpose, sound_machine()), "interface");
  CHECK(symptom.severity == Severity::Error);
  CHECK_THAT(symptom.cause, Contains("did you mean 'eth0'?"));
  CHECK_THAT(symptom.evidence, Contains("eth0 (10.0.0.2)"));
}

TEST_CASE("an interface may be named by its address") {
  Purpose purpose;
  purpose.interfaces = {"10.0.0.2"};
  CHECK(only(diagnose_network(purpose, sound_machine()), "interface").severity == Severity::Fine);
}

TEST_CASE("an interface that is down, has no address or takes no multicast keeps peers apart") {
  Facts facts = sound_machine();
  Interface& eth0 = facts.interfaces[1];
  Purpose purpose = on_eth0();
  std::string cause;
  SECTION("down") {
    eth0.up = false;
    cause = "eth0 is down";
  }
  SECTION("without an address") {
    eth0.addresses.clear();
    cause = "no IPv4 address";
  }
  SECTION("without multicast, where peers find each other by it") {
    eth0.multicast = false;
    purpose.multicast = true;
    cause = "takes no multicast";
  }
  const Symptom symptom = only(diagnose_network(purpose, facts), "interface");
  CHECK(symptom.severity == Severity::Error);
  CHECK_THAT(symptom.cause, Contains(cause));
}

TEST_CASE("an interface without a carrier is a warning: a peer on Cyclone DDS may wait for it") {
  Facts facts = sound_machine();
  facts.interfaces[1].running = false;
  const Symptom symptom = only(diagnose_network(on_eth0(), facts), "interface");
  CHECK(symptom.severity == Severity::Warning);
  CHECK_THAT(symptom.cause, Contains("eth0 has no carrier") && Contains("Fast DDS"));
}

TEST_CASE("an interface without multicast is fine where hosts are named") {
  Facts facts = sound_machine();
  facts.interfaces[1].multicast = false;
  const Symptom symptom = only(diagnose_network(on_eth0(), facts), "interface");
  CHECK(symptom.severity == Severity::Fine);
  CHECK_THAT(symptom.cause, Contains("hosts must be named"));
}

TEST_CASE("buffers that are smaller than what Skein asks for are a warning") {
  Facts facts = sound_machine();
  facts.buffer = 212992;
  const Symptom symptom = only(diagnose_network({}, facts), "buffers");
  CHECK(symptom.severity == Severity::Warning);
  CHECK_THAT(symptom.cause, Contains("208 KiB of the 4 MiB"));
  CHECK_THAT(symptom.remedy, Contains("net.core.rmem_max=4194304"));
}

TEST_CASE("packets that a socket of the domain had no room for are told with whose it is") {
  Facts facts = sound_machine();
  facts.sockets = {socket_of(7400 + 250 * 3 + 11, 12, "navigator", 1234),
                   socket_of(9999, 13, "other", 5)};
  Purpose purpose;
  purpose.domain = 3;
  const Symptom symptom = only(diagnose_network(purpose, facts), "lost packets");
  CHECK_THAT(symptom.cause, Contains("navigator (pid 12)"));
  CHECK_THAT(symptom.evidence, Contains("1234 dropped at UDP port 8161"));
}

TEST_CASE("a program of the domain that is stopped is told once, with how it goes on") {
  Facts facts = sound_machine();
  facts.sockets = {socket_of(7411, 12, "skein", 0), socket_of(7412, 12, "skein", 0),
                   socket_of(7413, 13, "skein", 0), socket_of(9999, 14, "other", 0)};
  for (UdpSocket& socket : facts.sockets) {
    socket.owner.stopped = socket.owner.pid != 13;
    socket.owner.command = "skein peer mission.xml tide";
  }
  const Symptom symptom = only(diagnose_network({}, facts), "stopped");
  CHECK(symptom.severity == Severity::Warning);
  CHECK_THAT(symptom.cause, Contains("skein (pid 12) is stopped"));
  CHECK_THAT(symptom.evidence,
             Contains("UDP port 7411") && Contains("`skein peer mission.xml tide`"));
  CHECK_THAT(symptom.remedy, Contains("kill -CONT 12"));
}

TEST_CASE("others on the domain of a mission that is to fly are a warning, else a note") {
  Facts facts = sound_machine();
  facts.sockets = {socket_of(7400, 7, "talker"), socket_of(7411, 7, "talker"),
                   socket_of(7413, 0, "")};
  Purpose purpose;
  CHECK(only(diagnose_network(purpose, facts), "domain").severity == Severity::Note);
  purpose.mission = "survey";
  const Symptom symptom = only(diagnose_network(purpose, facts), "domain");
  CHECK(symptom.severity == Severity::Warning);
  CHECK_THAT(symptom.cause, Contains("others speak on domain 0") && Contains("'survey'"));
  CHECK_THAT(symptom.evidence, Contains("another user's process, talker (pid 7)"));
  facts.launchers = {{0, {5, "skein"}}};
  CHECK(only(diagnose_network(purpose, facts), "domain").severity == Severity::Note);
  purpose.domain = 1;
  CHECK(only(diagnose_network(purpose, facts), "domain").severity == Severity::Fine);
}

TEST_CASE("a domain whose ports are all taken is an error") {
  Facts facts = sound_machine();
  for (std::uint16_t port = 7410; port < 7650; port += 2)
    facts.sockets.push_back(socket_of(port, 100 + port, "peer"));
  CHECK(only(diagnose_network({}, facts), "domain").severity == Severity::Error);
  facts.sockets.pop_back();
  CHECK(only(diagnose_network({}, facts), "domain").severity == Severity::Note);
}

TEST_CASE("two missions on one domain are a warning, each on its own are none") {
  Facts facts = sound_machine();
  facts.launchers = {{42, {10, "skein"}}, {42, {11, "skein"}}, {7, {12, "skein"}}};
  const Symptom symptom = only(diagnose_network({}, facts), "missions");
  CHECK(symptom.severity == Severity::Warning);
  CHECK_THAT(symptom.cause, Contains("2 missions fly on domain 42"));
  CHECK_THAT(symptom.evidence, Contains("skein (pid 10), skein (pid 11)"));
  facts.launchers.pop_back();
  facts.launchers.pop_back();
  CHECK(worst_of(diagnose_network({}, facts)) == Severity::Fine);
}

TEST_CASE("a firewall that drops is a note with its rule and the ports of the domain") {
  Facts facts = sound_machine();
  facts.firewall = std::nullopt;
  CHECK(only(diagnose_network({}, facts), "firewall").severity == Severity::Note);
  facts.firewall = "table inet filter {\n\tchain input {\n\t\tudp dport 53 accept\n\t}\n}\n";
  CHECK(only(diagnose_network({}, facts), "firewall").severity == Severity::Fine);
  facts.firewall->insert(facts.firewall->find("\t\tudp"), "\t\tudp dport 7400-7500 drop\n");
  const Symptom symptom = only(diagnose_network({}, facts), "firewall");
  CHECK(symptom.severity == Severity::Note);
  CHECK(symptom.evidence == "udp dport 7400-7500 drop");
  CHECK_THAT(symptom.remedy, Contains("UDP ports 7400-7649"));
}

TEST_CASE("ports of a domain are its 250, and of the last one those that there are") {
  CHECK(ports_of(0).first == 7400);
  CHECK(ports_of(0).last == 7649);
  CHECK(ports_of(232).first == 65400);
  CHECK(ports_of(232).last == 65535);
}
