#include "view/client.hpp"

#include <exception>
#include <utility>

#include "core/printable.hpp"
#include "skein/error.hpp"

namespace skein::view {
namespace {

void run(const Server::OnCall& on_call, const std::string& request, const Answer& answer) {
  try {
    on_call(request, answer);
  } catch (const std::exception& error) {
    answer.fail(error.what());
  }
}

}  // namespace

Client::Client(std::shared_ptr<ServerState> state, Connection& connection)
    : state_(std::move(state)), connection_(connection), outbox_(state_->options.queue) {
  std::lock_guard lock(state_->mutex);
  number_ = ++state_->last_client;
  state_->clients.emplace(number_, this);
  push(server_info(state_->options.name, state_->session));
  push(state_->all_channels());
  if (!state_->services.empty()) push(state_->all_services());
}

Client::~Client() {
  std::lock_guard lock(state_->mutex);
  state_->clients.erase(number_);
  for (const auto& [subscription, channel] : subscriptions_) {
    state_->unsubscribe(*this, channel);
  }
}

void Client::on_text(std::string_view message) { obey(message, decode_text); }

void Client::on_binary(std::string_view message) { obey(message, decode_binary); }

std::optional<Frame> Client::next() {
  std::lock_guard lock(state_->mutex);
  if (!is_to_be_told_of_dropped()) return outbox_.pop();
  told_dropped_ = outbox_.dropped();
  return status(Level::Warning,
                std::to_string(told_dropped_) +
                    (told_dropped_ == 1 ? " sample was" : " samples were") +
                    " dropped so far: this client takes them slower than they come",
                "dropped");
}

// Few times: some clients show all of these, one below the other.
bool Client::is_to_be_told_of_dropped() const {
  return outbox_.dropped() > 0 && outbox_.dropped() >= 2 * told_dropped_;
}

void Client::push(Frame message) {
  if (outbox_.push(std::move(message))) {
    connection_.wake();
  } else {
    connection_.drop();
  }
}

void Client::push_sample(std::uint32_t subscription, Frame sample) {
  outbox_.push_sample(subscription, std::move(sample));
  connection_.wake();
}

template <class Decode>
void Client::obey(std::string_view message, const Decode& decode) {
  try {
    auto decoded = decode(message);
    std::lock_guard lock(state_->mutex);
    std::visit([this](auto& one) { obey(one); }, decoded);
  } catch (const InvalidArgument& error) {
    std::lock_guard lock(state_->mutex);
    complain(error.what());
  }
}

void Client::obey(const Subscribe& message) {
  for (const auto& [id, channel] : message.subscriptions) subscribe(id, channel);
}

void Client::subscribe(std::uint32_t subscription, ChannelId channel) {
  const auto offered = state_->channels.find(channel);
  if (offered == state_->channels.end()) {
    return complain("there is no channel " + std::to_string(channel) + " to subscribe to");
  }
  const auto standing = subscriptions_.find(subscription);
  if (standing != subscriptions_.end() && state_->channels.contains(standing->second)) {
    return complain("the subscription " + std::to_string(subscription) +
                    " stands already; choose another number");
  }
  if (!offered->second.subscriptions.emplace(this, subscription).second) {
    return complain("the channel " + std::to_string(channel) + " is subscribed to already");
  }
  subscriptions_.insert_or_assign(subscription, channel);
  state_->note_watched(offered->second);
}

void Client::obey(const Unsubscribe& message) {
  for (const std::uint32_t subscription : message.subscriptions) {
    const auto found = subscriptions_.find(subscription);
    if (found == subscriptions_.end()) {
      complain("there is no subscription " + std::to_string(subscription) + " to end");
      continue;
    }
    outbox_.forget(subscription);
    state_->unsubscribe(*this, found->second);
    subscriptions_.erase(found);
  }
}

void Client::obey(SubscribeGraph /*message*/) {
  looks_at_graph_ = true;
  push(graph_update(change({}, state_->graph)));
}

void Client::obey(UnsubscribeGraph /*message*/) { looks_at_graph_ = false; }

void Client::obey(CallService& message) {
  const auto refuse = [&](const std::string& text) {
    push(call_failure(message.service, message.call, text));
  };
  const auto offered = state_->services.find(message.service);
  if (offered == state_->services.end()) {
    return refuse("there is no service " + std::to_string(message.service));
  }
  if (message.encoding != kCallEncoding) {
    return refuse("requests are encoded as " + std::string(kCallEncoding) + ", not as '" +
                  printable(message.encoding) + "'");
  }
  if (!state_->callbacks) return;  // it is being closed
  if (calls_ >= kMaxCalls) {
    return refuse(std::to_string(calls_) + " calls of this client wait for their answers already");
  }
  ++calls_;
  Answer answer(std::make_shared<Answer::Call>(state_, number_, message.service, message.call));
  state_->callbacks->post([on_call = offered->second.on_call, request = std::move(message.request),
                           answer = std::move(answer)] { run(*on_call, request, answer); });
}

// The text may quote what the client has sent.
void Client::complain(const std::string& text) {
  constexpr std::size_t kLongest = 1024;
  push(status(Level::Error, printable(text, kLongest)));
}

}  // namespace skein::view
