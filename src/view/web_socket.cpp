#include "view/web_socket.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstddef>
#include <list>
#include <map>
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
/// Connections that are not clients yet.
constexpr std::size_t kNewcomers = 128;
/// What of a message waits in the kernel: more would become old there, where a newer one cannot
/// take its place.
constexpr int kUnsentBytes = 64 << 10;
constexpr std::chrono::milliseconds kAfterFailedAccept{100};

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

/// Octets that the other side's kernel has taken: it takes no more while nobody reads them.
std::uint64_t acknowledged_by(tcp::socket& socket) {
  struct {
    ::tcp_info known;  // the C library's ends before what is needed
    std::uint64_t pacing_rate, max_pacing_rate, acknowledged;
  } info{};
  static_assert(offsetof(decltype(info), acknowledged) == 120);  // as <linux/tcp.h> has it
  socklen_t size = sizeof info;
  ::getsockopt(socket.native_handle(), IPPROTO_TCP, TCP_INFO, &info, &size);
  return info.acknowledged;
}

class BeastConnection;

/// What the connections share. Only the listener's thread uses it.
struct House {
  WebSocketOptions options;
  WebSocketListener::Judge judge;
  WebSocketListener::Open open;
  std::list<BeastConnection*> newcomers;  // in the order in which they came
  std::size_t clients = 0;
};

class BeastConnection final : public Connection,
                              public std::enable_shared_from_this<BeastConnection> {
 public:
  BeastConnection(tcp::socket socket, std::shared_ptr<House> house)
      : house_(std::move(house)), stream_(std::move(socket)), look_(stream_.get_executor()) {
    error_code error;
    address_ = this->socket().socket().remote_endpoint(error).address();
    house_->newcomers.push_back(this);
  }

  ~BeastConnection() override {
    session_.reset();
    std::erase(house_->newcomers, this);
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

  const asio::ip::address& address() const noexcept { return address_; }

  // What still reads or writes ends with the socket, and then lets go of the connection.
  void end() {
    session_.reset();
    std::erase(house_->newcomers, this);
    look_.cancel();
    socket().close();
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
    auto reply = house_->judge(
        {view_of(request.method_string()), view_of(request.target()),
         view_of(request[http::field::host]), view_of(request[http::field::origin]),
         view_of(request[http::field::sec_websocket_protocol]), websocket::is_upgrade(request)});
    if (!reply && house_->clients >= house_->options.max_clients) {
      reply = Reply{503, "There are " + std::to_string(house_->clients) +
                             " clients, and no more are taken.\n"};
    }
    if (reply) return send(std::move(*reply));
    admitted_ = true;
    ++house_->clients;
    std::erase(house_->newcomers, this);
    accept();
  }

  void send(Reply reply) {
    const auto response = std::make_shared<http::response<http::string_body>>(
        http::int_to_status(reply.status), parser_.get().version(), std::move(reply.text));
    for (const auto& [name, value] : reply.headers) response->set(name, value);
    response->keep_alive(false);
    response->prepare_payload();
    http::async_write(
        socket(), *response,
        [self = shared_from_this(), response](error_code, std::size_t) { self->end(); });
  }

  void accept() {
    buffer_.clear();
    socket().expires_never();
    stream_.set_option(websocket::stream_base::timeout{house_->options.handshake,
                                                       websocket::stream_base::none(), false});
    stream_.control_callback([this](websocket::frame_type, beast::string_view) { heard_ = true; });
    if (const std::string& protocol = house_->options.protocol; !protocol.empty()) {
      stream_.set_option(
          websocket::stream_base::decorator([protocol](websocket::response_type& response) {
            response.set(http::field::sec_websocket_protocol, protocol);
          }));
    }
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
    look_later();
  }

  void look_later() {
    look_.expires_after(house_->options.patience / kLooks);
    look_.async_wait([weak = weak_from_this()](error_code error) {
      const auto self = weak.lock();
      if (self && !error && self->session_) self->look();
    });
  }

  /// Ends a client of which nothing was heard for `patience`, though it was asked. A message that
  /// is on its way to a slow client keeps the question from it: then the client lives if it takes
  /// more of the message.
  void look() {
    const bool was_writing = std::exchange(seen_writing_, writing_);
    const std::uint64_t before = std::exchange(acknowledged_, acknowledged_by(socket().socket()));
    const bool takes = was_writing && writing_ && acknowledged_ > before;
    silent_looks_ = std::exchange(heard_, false) || takes ? 0 : silent_looks_ + 1;
    if (silent_looks_ >= kLooks) return end();
    if (silent_looks_ > 0) ask();
    look_later();
  }

  void ask() {
    if (std::exchange(asking_, true)) return;
    stream_.async_ping({}, [self = shared_from_this()](error_code) { self->asking_ = false; });
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->end();
      self->heard_ = true;
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

  /// In a client's patience.
  static constexpr int kLooks = 4;

  const std::shared_ptr<House> house_;
  websocket::stream<beast::tcp_stream, false> stream_;
  beast::flat_buffer buffer_;
  http::request_parser<http::empty_body> parser_;
  bool admitted_ = false;
  bool writing_ = false;
  Frame frame_;
  std::atomic<bool> waking_{false};
  std::unique_ptr<Session> session_;
  asio::ip::address address_;
  asio::steady_timer look_;
  bool heard_ = false;  // since the last look, as what follows
  bool seen_writing_ = false;
  std::uint64_t acknowledged_ = 0;
  int silent_looks_ = 0;
  bool asking_ = false;
};

/// Whoever comes is let in to the gate: of the address that has most connections before it, the one
/// goes that has waited longest.
void make_room(const House& house) {
  if (house.newcomers.size() < kNewcomers) return;
  std::map<asio::ip::address, std::size_t> counts;
  for (const BeastConnection* each : house.newcomers) ++counts[each->address()];
  const auto most =
      std::ranges::max_element(counts, {}, [](const auto& each) { return each.second; });
  const auto oldest = std::ranges::find(house.newcomers, most->first, &BeastConnection::address);
  (*oldest)->end();
}

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
  State(const WebSocketOptions& options, Judge judge, Open open)
      : house(std::make_shared<House>(House{options, std::move(judge), std::move(open), {}})),
        acceptor(listen(context, options)),
        port(acceptor.local_endpoint().port()) {}

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error) return accept_later();
      make_room(*house);
      socket.set_option(tcp::no_delay(true), error);
      socket.set_option(
          asio::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>(kUnsentBytes),
          error);
      std::make_shared<BeastConnection>(std::move(socket), house)->read_request();
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

WebSocketListener::WebSocketListener(const WebSocketOptions& options, Judge judge, Open open)
    : state_(std::make_unique<State>(options, std::move(judge), std::move(open))) {
  state_->accept();
  state_->thread = start_thread("skein-view", [state = state_.get()] { state->run(); });
}

WebSocketListener::~WebSocketListener() {
  state_->context.stop();
  state_->thread.join();
}

std::uint16_t WebSocketListener::port() const { return state_->port; }

}  // namespace skein::view
