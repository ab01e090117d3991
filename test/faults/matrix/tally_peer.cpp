// A process of the fault matrix: an entity with the tally service, with clients of it, or with
// both, that writes what they do into a journal. It obeys the lines it reads, answers each with one
// line, and ends with its standard input. Arguments are `name=value`; commands stand in obey().
#include <malloc.h>

#include <csignal>
#include <iostream>
#include <sstream>

#include "brokerless_discovery/broker.hpp"
#include "skein/error.hpp"
#include "tally_client.hpp"
#include "test/faults/exposed_service.hpp"
#include "test/faults/peer_arguments.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

class TallyService : public ::test::Tally {
 public:
  explicit TallyService(Journal& journal) : journal_(journal) {}

  std::vector<std::uint8_t> count(std::uint64_t number, std::uint32_t work_ms,
                                  const std::vector<std::uint8_t>& content) override {
    journal_.execute(number);
    std::this_thread::sleep_for(std::chrono::milliseconds(work_ms));
    return content;
  }

  void count_and_die(std::uint64_t number) override {
    journal_.execute(number);
    std::raise(SIGKILL);
  }

 private:
  Journal& journal_;
};

/// `name value` pairs of a command's rest.
CallShape shape_from(std::istringstream& rest) {
  CallShape shape;
  std::string name;
  std::uint64_t value = 0;
  while (rest >> name >> value) {
    if (name == "timeout") shape.timeout = std::chrono::milliseconds(value);
    if (name == "work") shape.work_ms = static_cast<std::uint32_t>(value);
    if (name == "bytes") shape.max_bytes = value;
    if (name == "pause") shape.pause = std::chrono::milliseconds(value);
  }
  return shape;
}

class Peer {
 public:
  explicit Peer(const PeerArguments& arguments)
      : journal_(arguments.at("journal")),
        first_(std::stoull(arguments.at("number")) << 48),
        entity_(entity_options(arguments)) {}

  std::string obey(const std::string& command, std::istringstream& rest) {
    if (command == "provide") return provide(number(rest));
    if (command == "server") return server();
    if (command == "services") return services();
    if (command == "connect") return connect(number(rest));
    if (command == "disconnect") return clients_.clear(), "disconnected";
    if (command == "start") return start(shape_from(rest));
    if (command == "stop") return stop();
    if (command == "call") return call(shape_from(rest));
    if (command == "kill") return "killed " + clients_.front()->call_and_kill(10s);
    if (command == "burst") return burst(rest);
    if (command == "settle") return settle();
    if (command == "pending") return pending();
    if (command == "heap") return heap();
    return "error no command '" + command + "'";
  }

 private:
  static std::size_t number(std::istringstream& rest) {
    std::size_t value = 0;
    rest >> value;
    return value;
  }

  std::string provide(std::size_t queue) {
    service_.emplace(entity_, std::make_shared<TallyService>(journal_), queue);
    return "provided";
  }

  std::string server() {
    const auto counters = service_->counters();
    return "server " + std::to_string(counters.active) + " " + std::to_string(counters.clients) +
           " " + std::to_string(service_->sessions());
  }

  std::string services() {
    const auto& broker = entity_.broker();
    return "services " + std::to_string(broker.find_service(broker.query("test::Tally")).size());
  }

  // Every other one is exposed.
  std::string connect(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      clients_.push_back(
          std::make_unique<TallyClient>(entity_, journal_, first_, clients_.size() % 2 != 0));
      first_ += 1ull << 32;
    }
    return "connected";
  }

  std::string start(const CallShape& shape) {
    for (auto& client : clients_) client->start(shape);
    return "started";
  }

  std::string stop() {
    std::uint64_t succeeded = 0;
    for (auto& client : clients_) succeeded += client->stop();
    return "stopped " + std::to_string(succeeded);
  }

  // One call of each client; one whose connection was lost without its knowing learns of it so, and
  // tries again.
  std::string call(const CallShape& shape) {
    std::string outcome = "Ok";
    for (auto& client : clients_) {
      std::string one = client->call(shape);
      for (int i = 0; i < 2 && (one == "Disconnected" || one == "Unavailable"); ++i)
        one = client->call(shape);
      if (one != "Ok") outcome = one;
    }
    return "called " + outcome;
  }

  std::string burst(std::istringstream& rest) {
    const int calls = static_cast<int>(number(rest));
    const CallShape shape = shape_from(rest);
    for (auto& client : clients_) client->burst(calls, shape);
    return "sent";
  }

  std::string settle() {
    for (auto& client : clients_) client->settle();
    return "settled";
  }

  std::string pending() const {
    std::size_t count = 0;
    for (const auto& client : clients_) count += client->pending();
    return "pending " + std::to_string(count);
  }

  // What is in use of it, in bytes.
  static std::string heap() {
    const struct mallinfo2 all = mallinfo2();
    return "heap " + std::to_string(all.uordblks + all.hblkhd);
  }

  Journal journal_;
  std::uint64_t first_;
  Entity entity_;
  std::optional<ExposedService> service_;
  std::vector<std::unique_ptr<TallyClient>> clients_;
};

}  // namespace

int main(int count, char** given) {
  return run_peer([&] { return std::make_unique<Peer>(parse_arguments(count, given)); });
}
