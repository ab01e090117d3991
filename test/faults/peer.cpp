// The other process of these tests: an entity that obeys the lines it reads and answers each with
// one line. It ends with its standard input. Arguments are `name=value`; commands stand in main().
#include <iostream>
#include <sstream>

#include "../connector/echo_service.hpp"
#include "peer_arguments.hpp"
#include "skein/core/error.hpp"
#include "skein/entity/entity.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;

namespace {

using SteadyClock = std::chrono::steady_clock;

class Peer {
 public:
  Peer(const PeerArguments& arguments, SteadyClock::time_point start)
      : start_(start), entity_(entity_options(arguments)) {}

  std::string obey(const std::string& command, std::istringstream& rest) {
    if (command == "provide") return provide();
    if (command == "calls") return "calls " + std::to_string(service_->calls);
    if (command == "services") return services();
    if (command == "connect") return connect({.name = word(rest), .timeout = 20s});
    if (command == "echo") return echo(rest);
    if (command == "octets") return octets(rest);
    if (command == "pour") return pour(rest);
    if (command == "wait") return wait();
    if (command == "outcome") return outcome();
    return "error no command '" + command + "'";
  }

 private:
  static std::string word(std::istringstream& rest) {
    std::string text;
    rest >> text;
    return text;
  }

  std::string since_start() const {
    return std::to_string(
        std::chrono::duration_cast<std::chrono::milliseconds>(SteadyClock::now() - start_).count());
  }

  std::string provide() { return "provided " + entity_.provide<LouderEcho>(service_).hex(); }

  std::string services() {
    const auto& broker = entity_.broker();
    return "services " + std::to_string(broker.find_service(broker.query("test::Echo")).size());
  }

  std::string connect(const ConnectOptions& options) {
    echo_.emplace(entity_.connect<LouderEcho>(options));
    return "connected " + since_start();
  }

  std::string echo(std::istringstream& rest) {
    int times = 0;
    std::string text;
    rest >> times >> text;
    for (int i = 0; i < times; ++i) {
      if (echo_->within(10s).echo(text) != text) return "error the echo is another one";
    }
    return "echoed " + since_start();
  }

  std::string octets(std::istringstream& rest) {
    std::size_t size = 0;
    std::string text;
    rest >> size >> text;
    std::vector<std::uint8_t> content(size);
    for (std::size_t i = 0; i < size; ++i)
      content[i] = static_cast<std::uint8_t>(text[i % text.size()]);
    return echo_->within(20s).echo_octets(content) == content ? "echoed " + since_start()
                                                              : "error the echo is another one";
  }

  // Calls whose answers nobody takes.
  std::string pour(std::istringstream& rest) {
    const int times = std::stoi(word(rest));
    for (int i = 0; i < times; ++i) poured_.push_back(echo_->within(60s).async_shout("more"));
    return "poured";
  }

  std::string wait() {
    waiting_.emplace(echo_->within(10min).async_wait(600'000));
    return "waiting";
  }

  std::string outcome() {
    const bool waited = waiting_->get();
    return waited ? "outcome true" : "outcome false";
  }

  const SteadyClock::time_point start_;
  const std::shared_ptr<EchoService> service_ = std::make_shared<EchoService>();
  Entity entity_;
  std::optional<LouderEcho::Proxy> echo_;
  std::vector<Call<std::string>> poured_;
  std::optional<Call<bool>> waiting_;
};

}  // namespace

int main(int count, char** given) {
  const auto start = SteadyClock::now();
  return run_peer([&] { return std::make_unique<Peer>(parse_arguments(count, given), start); });
}
