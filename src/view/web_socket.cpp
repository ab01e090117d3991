#include "view/web_socket.hpp"

#include <pthread.h>

#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <thread>
#include <utility>

#include "core/log.hpp"
#include "core/printable.hpp"
#include "core/threads/start_thread.hpp"
#include "skein/error.hpp"

// No other unit includes Boost.Beast, which takes long to compile.
namespace skein::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

constexpr const char* kPlace = "view";
/// Connections beside the clients': they are on their way in, or out.
constexpr std::size_t kNewcomers = 32;
constexpr std::chrono::milliseconds kAfterFailedAccept{100};

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

/// What the connections share. Only the listener's thread uses it.
struct House {
  WebSocketOptions options;
  Gate gate;
  WebSocketListener::Open open;
  std::size_t connections = 0;
  std::size_t clients = 0;
};

class BeastConnection final : public Connection,
                              public std::enable_shared_from_this<BeastConnection> {
 public:
  BeastConnection(tcp::socket socket, std::shared_ptr<House> house)
      : house_(std::move(house)), stream_(std::move(socket)) {
    ++house_->connections;
  }

  ~BeastConnection() override {
    session_.reset();
    --house_->connections;
    if (admitted_) --house_->clients;
  }

  BeastConnection(const BeastConnection&) = delete;
  BeastConnection& operator=(const BeastConnection&) = delete;

  void read_request() {
    socket().expires_after(house_->options.handshake);
    http::async_read(socket(), buffer_, parser_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (!error) self->judge();
                     });
  }

  void wake() override {
    if (!waking_.exchange(true)) post([](BeastConnection& self) { self.write(); });
  }

  void drop() override {
    post([](BeastConnection& self) { self.end(); });
  }

 private:
  beast::tcp_stream& socket() { return beast::get_lowest_layer(stream_); }

  template <class Run>
  void post(Run run) {
    asio::post(stream_.get_executor(), [weak = weak_from_this(), run] {
      const auto self = weak.lock();
      if (!self) return;
      self->waking_ = false;
      run(*self);
    });
  }

  void judge() {
    const auto& request = parser_.get();
    auto refusal = house_->gate.refusal(
        {view_of(request.target()), view_of(request[http::field::origin]),
         view_of(request[http::field::sec_websocket_protocol]), websocket::is_upgrade(request)});
    if (!refusal && house_->clients >= house_->options.max_clients) {
      refusal = Refusal{503, "There are " + std::to_string(house_->clients) +
                                 " clients, and no more are taken.\n"};
    }
    if (refusal) return refuse(*refusal);
    admitted_ = true;
    ++house_->clients;
    accept();
  }

  void refuse(const Refusal& refusal) {
    const auto response = std::make_shared<http::response<http::string_body>>(
        http::int_to_status(refusal.status), parser_.get().version(), refusal.text);
    response->set(http::field::content_type, "text/plain; charset=utf-8");
    response->keep_alive(false);
    response->prepare_payload();
    http::async_write(
        socket(), *response,
        [self = shared_from_this(), response](error_code, std::size_t) { self->end(); });
  }

  void accept() {
    buffer_.clear();
    socket().expires_never();
    stream_.set_option(
        websocket::stream_base::timeout{house_->options.handshake, house_->options.patience, true});
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol,
                   beast::string_view(kProtocol.data(), kProtocol.size()));
    }));
    stream_.auto_fragment(false);
    stream_.read_message_max(house_->options.max_message);
    stream_.async_accept(parser_.get(), [self = shared_from_this()](error_code error) {
      if (!error) self->begin();
    });
  }

  void begin() {
    session_ = house_->open(*this);
    read();
    write();
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->end();
      self->hand_over();
    });
  }

  void hand_over() {
    if (!session_) return;
    const auto data = buffer_.data();
    const std::string_view message(static_cast<const char*>(data.data()), data.size());
    if (stream_.got_text()) {
      session_->on_text(message);
    } else {
      session_->on_binary(message);
    }
    buffer_.consume(buffer_.size());
    write();
    read();
  }

  void write() {
    if (!session_ || writing_) return;
    auto next = session_->next();
    if (!next) return;
    writing_ = true;
    frame_ = std::move(*next);
    stream_.text(frame_.text);
    const std::array<asio::const_buffer, 2> parts{
        asio::buffer(frame_.head), frame_.body ? asio::buffer(*frame_.body) : asio::const_buffer()};
    stream_.async_write(parts, [self = shared_from_this()](error_code error, std::size_t) {
      self->writing_ = false;
      self->frame_ = {};
      if (error) return self->end();
      self->write();
    });
  }

  // What still reads or writes ends with the socket, and then lets go of the connection.
  void end() {
    session_.reset();
    socket().close();
  }

  const std::shared_ptr<House> house_;
  websocket::stream<beast::tcp_stream, false> stream_;
  beast::flat_buffer buffer_;
  http::request_parser<http::empty_body> parser_;
  bool admitted_ = false;
  bool writing_ = false;
  Frame frame_;
  std::atomic<bool> waking_{false};
  std::unique_ptr<Session> session_;
};

tcp::endpoint endpoint_of(const WebSocketOptions& options) {
  error_code error;
  const auto address = asio::ip::make_address(options.address, error);
  if (error) {
    throw InvalidArgument("'" + printable(options.address) +
                          "' is no address of an interface, such as 127.0.0.1");
  }
  return {address, options.port};
}

tcp::acceptor listen(asio::io_context& context, const WebSocketOptions& options) {
  const tcp::endpoint endpoint = endpoint_of(options);
  try {
    return {context, endpoint};
  } catch (const boost::system::system_error& error) {
    throw Unavailable("port " + std::to_string(options.port) + " of " + options.address +
                      " cannot be had: " + error.code().message() + "; choose another");
  }
}

}  // namespace

struct WebSocketListener::State {
  State(const WebSocketOptions& options, Gate gate, Open open)
      : house(std::make_shared<House>(House{options, std::move(gate), std::move(open)})),
        acceptor(listen(context, options)),
        port(acceptor.local_endpoint().port()) {}

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error) return accept_later();
      if (house->connections < house->options.max_clients + kNewcomers) {
        socket.set_option(tcp::no_delay(true), error);
        std::make_shared<BeastConnection>(std::move(socket), house)->read_request();
      }
      accept();
    });
  }

  // No descriptor is left, say.
  void accept_later() {
    again.expires_after(kAfterFailedAccept);
    again.async_wait([this](error_code error) {
      if (!error) accept();
    });
  }

  void run() {
    pthread_setname_np(pthread_self(), "skein-view");
    while (!context.stopped()) {
      try {
        context.run();
      } catch (const std::exception& error) {  // no memory, say: that connection is gone
        log(LogLevel::Error, kPlace, std::string("a connection has ended: ") + error.what());
      }
    }
  }

  const std::shared_ptr<House> house;
  asio::io_context context{1};
  tcp::acceptor acceptor;
  asio::steady_timer again{context};
  const std::uint16_t port;
  std::thread thread;
};

WebSocketListener::WebSocketListener(const WebSocketOptions& options, Gate gate, Open open)
    : state_(std::make_unique<State>(options, std::move(gate), std::move(open))) {
  state_->accept();
  state_->thread = start_thread("skein-view", [state = state_.get()] { state->run(); });
}

WebSocketListener::~WebSocketListener() {
  state_->context.stop();
  state_->thread.join();
}

std::uint16_t WebSocketListener::port() const { return state_->port; }

}  // namespace skein::view
