#include "fuzzed_provider.hpp"

#include <arpa/inet.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "test/tools/wire_tap.hpp"

namespace skein::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatient = 60s;

ChildProcess start(const std::string& name, const dds::Vendor& vendor) {
  return start_peer(name, vendor);
}

// A packet that makes the provider take all memory is not to take the machine's.
void limit_memory([[maybe_unused]] pid_t process) {
#ifndef __SANITIZE_ADDRESS__
  constexpr rlim_t kEnough = rlim_t{6} << 30;
  const rlimit limit{kEnough, kEnough};
  prlimit(process, RLIMIT_AS, &limit, nullptr);
#endif
}

struct ProcessState {
  char letter = 'X';
  unsigned long ticks = 0;  // of CPU time
};

ProcessState state_of(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  ProcessState state;
  if (text.empty()) return state;
  std::istringstream rest(text.substr(text.rfind(')') + 1));
  std::string skipped;
  rest >> state.letter;
  for (int i = 0; i < 10; ++i) rest >> skipped;
  unsigned long user = 0, system = 0;
  rest >> user >> system;
  state.ticks = user + system;
  return state;
}

}  // namespace

FuzzedProvider::FuzzedProvider() : server_(start("server", *Pairing::get().server)) {
  WireTap tap;
  server_.ask("provide", kPatient);
  const auto call = [](ChildProcess& client) {
    client.ask("connect", kPatient);
    client.ask("echo 20 hello", kPatient);
    const std::string answer = client.ask("octets 300000 many", kPatient);
    if (!answer.starts_with("echoed")) throw std::runtime_error(answer);
  };
  {
    auto guest = start("guest", *Pairing::get().client);
    call(guest);
    guest.finish();
  }
  client_.emplace(start("client", *Pairing::get().client));
  call(*client_);
  const auto server_ports = udp_ports_of(server_.pid());
  const auto client_ports = udp_ports_of(client_->pid());
  for (const Packet& packet : tap.stop()) {
    if (!server_ports.contains(packet.destination_port)) continue;
    ports_.insert(packet.destination_port);  // some of its sockets only send
    const auto* octets = reinterpret_cast<const unsigned char*>(packet.content.data());
    packets_.emplace_back(octets, octets + packet.content.size());
    if (!client_ports.contains(packet.source_port)) continue;
    for (const DataSubmessage& data : user_data(packet)) writers_.insert(data.writer);
  }
  limit_memory(server_.pid());
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
}

FuzzedProvider::~FuzzedProvider() { close(socket_); }

void FuzzedProvider::send(const Octets& packet) {
  constexpr std::size_t kRoom = 64'000;
  constexpr std::size_t kKept = 64;
  constexpr std::size_t kOverhead = 768;  // what a small packet takes of a socket's room
  last_.push_back(packet);
  if (last_.size() > kKept) last_.pop_front();
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (const std::uint16_t port : ports_) {
    to.sin_port = htons(port);
    sendto(socket_, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
  }
  sent_ += packet.size() + kOverhead;
  if (sent_ >= kRoom) await_reading();
}

void FuzzedProvider::await_reading() {
  if (!eventually([&] { return unread() == 0; }, kPatient)) {
    const char letter = state_of(server_.pid()).letter;
    throw std::runtime_error(letter == 'Z' || letter == 'X' ? "it has died"
                                                            : "it does not read any more");
  }
  sent_ = 0;
}

std::size_t FuzzedProvider::unread() const {
  if (const char letter = state_of(server_.pid()).letter; letter == 'Z' || letter == 'X') {
    throw std::runtime_error("it has died");
  }
  return unread_bytes(ports_);
}

void FuzzedProvider::check_unharmed() {
  await_reading();
  const auto is_idle = [&] {
    constexpr auto kWindow = 500ms;
    const auto before = state_of(server_.pid());
    let_last(kWindow);
    const auto after = state_of(server_.pid());
    if (after.letter == 'Z' || after.letter == 'X') throw std::runtime_error("it has died");
    // It has timers: a tenth of a core is idle, a thread that spins is not.
    const auto limit = static_cast<unsigned long>(sysconf(_SC_CLK_TCK)) / 20;
    return after.ticks - before.ticks <= limit;
  };
  if (!eventually(is_idle, kPatient)) throw std::runtime_error("it does not fall idle");
  auto client = start("visitor", *Pairing::get().client);
  for (const char* command : {"connect", "echo 3 hello", "octets 100000 many"}) {
    const std::string answer = client.ask(command, kPatient);
    if (answer.starts_with("error")) {
      throw std::runtime_error("it does not answer '" + std::string(command) + "': " + answer);
    }
  }
  client.finish();
}

std::string FuzzedProvider::last_packets() const {
  std::ostringstream text;
  for (const Octets& packet : last_) {
    for (std::size_t i = 0; i < std::min<std::size_t>(packet.size(), 400); ++i) {
      constexpr char kDigits[] = "0123456789abcdef";
      text << kDigits[packet[i] >> 4] << kDigits[packet[i] & 15];
    }
    text << (packet.size() > 400 ? "...\n" : "\n");
  }
  return text.str();
}

}  // namespace skein::test
