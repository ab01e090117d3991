// The other process of these tests: an entity that obeys the lines it reads and answers each with
// one line. It ends with its standard input. Arguments are `name=value`; commands stand in main().
#include <algorithm>
#include <iostream>
#include <mutex>
#include <semaphore>
#include <sstream>

#include "brokerless_discovery/broker.hpp"
#include "core/log.hpp"
#include "peer_arguments.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/gather.hpp"
#include "test/connector/echo_service.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;

namespace {

using SteadyClock = std::chrono::steady_clock;

/// What the library has logged, where a test asked for it; it is then not on standard error.
class KeptLog {
 public:
  explicit KeptLog(const PeerArguments& arguments) {
    if (!arguments.contains("keep_log")) return;
    set_log_sink([lines = lines_](const LogLine& line) {
      std::lock_guard lock(lines->mutex);
      if (lines->text.size() >= kMax) return;
      lines->text.append(line.place).append(": ").append(line.text) += "; ";
    });
  }

  std::string text() const {
    std::lock_guard lock(lines_->mutex);
    std::string line = lines_->text;
    std::ranges::replace(line, '\n', ' ');
    return line.empty() ? "nothing" : line;
  }

 private:
  static constexpr std::size_t kMax = 4096;
  /// Vendors' threads may still log when the peer has ended.
  struct Lines {
    std::mutex mutex;
    std::string text;
  };
  const std::shared_ptr<Lines> lines_ = std::make_shared<Lines>();
};

class Peer {
 public:
  Peer(const PeerArguments& arguments, SteadyClock::time_point start)
      : start_(start), log_(arguments), entity_(entity_options(arguments)) {}

  std::string obey(const std::string& command, std::istringstream& rest) {
    if (command == "provide") return provide();
    if (command == "calls") return "calls " + std::to_string(service_->calls);
    if (command == "inside") return "inside " + std::to_string(service_->inside);
    if (command == "services") return services();
    if (command == "gather") return gather(rest);
    if (command == "logged") return "logged " + log_.text();
    if (command == "connect") return connect({.name = word(rest), .timeout = 20s});
    if (command == "echo") return echo(rest);
    if (command == "octets") return octets(rest);
    if (command == "pour") return pour(rest);
    if (command == "listen") return listen();
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

  // Waits for so many providers, for so many seconds: tells whose services it knows then.
  std::string gather(std::istringstream& rest) {
    std::size_t wanted = 0;
    int seconds = 0;
    rest >> wanted >> seconds;
    const auto& broker = entity_.broker();
    const auto find = [&] { return broker.find_service(broker.query("test::Echo")); };
    const auto news = std::make_shared<std::counting_semaphore<>>(0);
    const auto observation =
        entity_.broker().observe([news](const brokerless_discovery::Change&) { news->release(); });
    const auto end = SteadyClock::now() + std::chrono::seconds(seconds);
    while (find().size() < wanted && news->try_acquire_until(end)) {
    }
    std::string known = "known";
    for (const auto& description : find()) known += " " + description->entity;
    return known;
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

  // Takes one item of a long stream.
  std::string listen() {
    heard_.emplace(echo_->within(10min).count_up(1'000'000, -1));
    return heard_->next() ? "listens" : "error the stream has ended";
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
  const KeptLog log_;
  const std::shared_ptr<EchoService> service_ = std::make_shared<EchoService>();
  Entity entity_;
  std::optional<LouderEcho::Proxy> echo_;
  std::vector<Call<std::string>> poured_;
  std::optional<Call<bool>> waiting_;
  std::optional<Stream<std::int32_t>> heard_;
};

}  // namespace

int main(int count, char** given) {
  const auto start = SteadyClock::now();
  return run_peer([&] { return std::make_unique<Peer>(parse_arguments(count, given), start); });
}
