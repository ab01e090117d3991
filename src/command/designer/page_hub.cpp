#include "page_hub.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace skein::command::designer {
namespace {

/// After a program has read the state without being a client.
constexpr std::chrono::seconds kInterest{10};

using Json = nlohmann::json;

/// The number by which the client knows its request again.
Json request_number(std::string_view request) {
  const Json read = Json::parse(request, nullptr, false);
  if (!read.is_object() || !read.contains("request")) return {};
  const Json& number = read["request"];
  return number.is_number() || number.is_string() ? number : Json();
}

std::string answer_text(const Json& number, bool done, const std::string& text) {
  const Json answer{{"request", number}, {"done", done}, {"text", text}};
  return answer.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

class PageHub::Client final : public view::Session {
 public:
  Client(std::shared_ptr<PageHub> hub, std::uint64_t number)
      : hub_(std::move(hub)), number_(number) {}
  ~Client() override { hub_->leave(number_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void on_text(std::string_view message) override { hub_->take(number_, std::string(message)); }
  void on_binary(std::string_view) override {
    hub_->answer(number_, answer_text({}, false, "requests are text"));
  }
  std::optional<view::Frame> next() override { return hub_->next(number_); }

 private:
  const std::shared_ptr<PageHub> hub_;
  const std::uint64_t number_;
};

PageHub::~PageHub() { close(); }

void PageHub::close() {
  quick_.stop();
  waiting_.stop();
}

void PageHub::publish(Kind kind, std::shared_ptr<const std::string> state) {
  std::lock_guard lock(mutex_);
  State& place = states_[static_cast<std::size_t>(kind)];
  place.text = std::move(state);
  ++place.number;
  for (const auto& [number, client] : clients_) client.connection->wake();
}

std::shared_ptr<const std::string> PageHub::look(Kind kind) {
  std::lock_guard lock(mutex_);
  looked_ = std::chrono::steady_clock::now();
  return states_[static_cast<std::size_t>(kind)].text;
}

bool PageHub::is_watched() const {
  std::lock_guard lock(mutex_);
  const bool asked = looked_.time_since_epoch().count() > 0 &&
                     std::chrono::steady_clock::now() - looked_ < kInterest;
  return asked || !clients_.empty();
}

std::unique_ptr<view::Session> PageHub::open(view::Connection& connection) {
  std::lock_guard lock(mutex_);
  const std::uint64_t number = ++last_client_;
  clients_[number] = {&connection};
  return std::make_unique<Client>(shared_from_this(), number);
}

void PageHub::take(std::uint64_t client, std::string request) {
  {
    std::lock_guard lock(mutex_);
    Place& place = clients_.at(client);
    if (place.requests >= kRequests) {
      place.connection->drop();
      return;
    }
    ++place.requests;
  }
  ThreadExecutor& executor = obey_.may_wait(request) ? waiting_ : quick_;
  executor.post([this, client, request = std::move(request)] {
    const Json number = request_number(request);
    std::string text;
    try {
      text = answer_text(number, true, obey_.obey(request));
    } catch (const std::exception& error) {
      text = answer_text(number, false, error.what());
    }
    answer(client, std::move(text));
  });
}

void PageHub::answer(std::uint64_t client, std::string text) {
  std::lock_guard lock(mutex_);
  const auto place = clients_.find(client);
  if (place == clients_.end()) return;
  place->second.answers.push_back(std::move(text));
  place->second.connection->wake();
}

/// The state first, so that a client sees the effect of its request when the answer comes.
std::optional<view::Frame> PageHub::next(std::uint64_t client) {
  std::lock_guard lock(mutex_);
  Place& place = clients_.at(client);
  for (std::size_t kind = 0; kind < states_.size(); ++kind) {
    const State& state = states_[kind];
    if (!state.text || place.seen[kind] == state.number) continue;
    place.seen[kind] = state.number;
    return view::Frame{true, "", state.text};
  }
  if (place.answers.empty()) return std::nullopt;
  view::Frame frame{true, std::move(place.answers.front()), nullptr};
  place.answers.erase(place.answers.begin());
  if (place.requests > 0) --place.requests;
  return frame;
}

void PageHub::leave(std::uint64_t client) {
  std::lock_guard lock(mutex_);
  clients_.erase(client);
}

}  // namespace skein::command::designer
