// ZeroMQ as its guide advises for services: a ROUTER that serves all clients, a DEALER in each of
// them.

#include <string>
#include <thread>
#include <zmq.hpp>

#include "rivals/main.hpp"

namespace skein::benchmarks::rivals {
namespace {

std::string address_of(const Arguments& arguments) {
  return arguments.transport == "ipc" ? "ipc://" + arguments.path()
                                      : "tcp://127.0.0.1:" + std::to_string(arguments.port());
}

void serve(zmq::socket_t& socket) {
  try {
    while (true) {
      zmq::message_t client, request;
      (void)socket.recv(client);
      (void)socket.recv(request);
      const auto* octets = request.data<std::uint8_t>();
      const Content result(octets, octets + request.size());
      socket.send(client, zmq::send_flags::sndmore);
      socket.send(zmq::buffer(result), zmq::send_flags::none);
    }
  } catch (const zmq::error_t&) {  // the context is being closed
  }
}

void server(const Arguments& arguments) {
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::router);
  socket.bind(address_of(arguments));
  std::thread thread([socket = std::move(socket)]() mutable { serve(socket); });
  run_server();
  context.shutdown();
  thread.join();
  std::filesystem::remove(arguments.path());  // ZeroMQ leaves its sockets behind
}

/// A client: one socket, used by one thread at a time.
class Caller {
 public:
  Caller(zmq::context_t& context, const std::string& address)
      : socket_(context, zmq::socket_type::dealer) {
    socket_.set(zmq::sockopt::linger, 0);
    socket_.connect(address);
  }

  void send(const Content& content) { socket_.send(zmq::buffer(content), zmq::send_flags::none); }

  void receive(const Seen& seen) {
    zmq::message_t reply;
    (void)socket_.recv(reply);
    seen({reply.data<std::uint8_t>(), reply.size()});
  }

 private:
  zmq::socket_t socket_;
};

EchoCall call_of(const std::shared_ptr<Caller>& caller) {
  return [caller](const Content& content, const Seen& seen) {
    caller->send(content);
    caller->receive(seen);
  };
}

void client(const Arguments& arguments) {
  zmq::context_t context;
  const auto made = [&] { return std::make_shared<Caller>(context, address_of(arguments)); };
  const auto first = made();
  const EchoCall call = call_of(first);
  call({}, [](auto) {});
  run_client({call, [&] { return call_of(made()); },
              [&](const Content& content) {
                first->send(content);
                return [&] { first->receive([](auto) {}); };
              }});
}

}  // namespace
}  // namespace skein::benchmarks::rivals

int main(int argc, char** argv) {
  using namespace skein::benchmarks::rivals;
  return rival_main(argc, argv, [](const Arguments& arguments) {
    arguments.role == "server" ? server(arguments) : client(arguments);
  });
}
