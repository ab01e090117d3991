#include "tally_client.hpp"

#include "brokerless_discovery/broker.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"

namespace skein::test {
namespace {

using namespace std::chrono_literals;
using ::test::Tally;

constexpr auto kConnectPatience = 30s;

std::shared_ptr<rpc::RemoteChannel> open_channel(Entity& entity, Duration patience) {
  const auto deadline = entity.clock().now() + patience;
  const auto& broker = entity.broker();
  const auto found = broker.await_service(broker.query("test::Tally"), deadline);
  return std::dynamic_pointer_cast<rpc::RemoteChannel>(
      entity.connector().open_provider(*found.front(), "", deadline - entity.clock().now()));
}

}  // namespace

TallyClient::TallyClient(Entity& entity, Journal& journal, std::uint64_t first, bool exposed)
    : entity_(entity), journal_(journal), next_(first), exposed_(exposed) {
  if (exposed_) {
    channel_ = open_channel(entity, kConnectPatience);
  } else {
    connected_.emplace(entity.connect<Tally>({.timeout = kConnectPatience}));
  }
}

TallyClient::~TallyClient() { stop(); }

Tally::Proxy TallyClient::proxy(std::chrono::milliseconds timeout) {
  if (!exposed_) return connected_->within(timeout);
  if (!channel_->connected()) channel_ = open_channel(entity_, timeout);
  return Tally::Proxy(channel_, timeout);
}

template <class Action>
std::string TallyClient::note(std::uint64_t number, Instant deadline, Action&& action) {
  std::string outcome;
  try {
    outcome = action() ? "Ok" : "Wrong";
    ++succeeded_;
  } catch (const Error& error) {
    outcome = to_string(error.code());
  }
  journal_.end(
      number, outcome,
      std::chrono::duration_cast<std::chrono::microseconds>(entity_.clock().now() - deadline)
          .count());
  return outcome;
}

std::string TallyClient::call(const CallShape& shape) {
  const std::uint64_t number = next_++;
  std::vector<std::uint8_t> content(
      shape.max_bytes == 0 ? 0 : number * 7919 % (shape.max_bytes + 1),
      static_cast<std::uint8_t>(number));
  journal_.begin(number);
  return note(number, entity_.clock().now() + shape.timeout, [&] {
    return proxy(shape.timeout).count(number, shape.work_ms, content) == content;
  });
}

std::string TallyClient::call_and_kill(std::chrono::milliseconds timeout) {
  const std::uint64_t number = next_++;
  journal_.begin(number);
  return note(number, entity_.clock().now() + timeout, [&] {
    proxy(timeout).count_and_die(number);
    return true;
  });
}

void TallyClient::start(const CallShape& shape) {
  stop_ = false;
  thread_ = std::thread([this, shape] {
    while (!stop_) {
      call(shape);
      std::this_thread::sleep_for(shape.pause);
    }
  });
}

std::uint64_t TallyClient::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  return succeeded_;
}

void TallyClient::burst(int calls, const CallShape& shape) {
  auto target = proxy(shape.timeout);
  const std::vector<std::uint8_t> content(shape.max_bytes);
  for (int i = 0; i < calls; ++i) {
    const std::uint64_t number = next_++;
    journal_.begin(number);
    const Instant deadline = entity_.clock().now() + shape.timeout;
    pending_.push_back({number, deadline, target.async_count(number, shape.work_ms, content)});
  }
}

void TallyClient::settle() {
  for (Pending& one : pending_) {
    note(one.number, one.deadline, [&] {
      one.call.get();
      return true;
    });
  }
  pending_.clear();
}

}  // namespace skein::test
