// gRPC's C++ API as its examples use it: a synchronous server, blocking calls, and for calls in
// flight its callback API.

#include <grpcpp/grpcpp.h>

#include <future>
#include <memory>

#include "echo.grpc.pb.h"
#include "rivals/main.hpp"

namespace skein::benchmarks::rivals {
namespace {

namespace rpc = benchmark::grpc_rival;
using rpc::Octets;

std::string address_of(const Arguments& arguments) {
  return arguments.transport == "unix" ? "unix:" + arguments.path()
                                       : "127.0.0.1:" + std::to_string(arguments.port());
}

class EchoService final : public rpc::Echo::Service {
 public:
  grpc::Status Call(grpc::ServerContext*, const Octets* request, Octets* reply) override {
    reply->set_content(request->content());
    return grpc::Status::OK;
  }
};

void server(const Arguments& arguments) {
  EchoService service;
  grpc::ServerBuilder builder;
  builder.AddListeningPort(address_of(arguments), grpc::InsecureServerCredentials());
  builder.RegisterService(&service);
  const std::unique_ptr<grpc::Server> running = builder.BuildAndStart();
  if (!running) throw Internal("gRPC cannot listen at " + address_of(arguments));
  run_server();
  running->Shutdown(std::chrono::system_clock::now());
}

void check(const grpc::Status& status) {
  if (!status.ok()) throw Internal("gRPC: " + status.error_message());
}

Octets message_of(const Content& content) {
  Octets message;
  message.set_content(content.data(), content.size());
  return message;
}

std::shared_ptr<rpc::Echo::Stub> make_stub(const Arguments& arguments) {
  grpc::ChannelArguments own;
  own.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);  // else all channels share one connection
  return rpc::Echo::NewStub(
      grpc::CreateCustomChannel(address_of(arguments), grpc::InsecureChannelCredentials(), own));
}

EchoCall call_of(const std::shared_ptr<rpc::Echo::Stub>& stub) {
  return [stub](const Content& content, const Seen& seen) {
    grpc::ClientContext context;
    context.set_wait_for_ready(true);
    Octets reply;
    check(stub->Call(&context, message_of(content), &reply));
    const auto* octets = reinterpret_cast<const std::uint8_t*>(reply.content().data());
    seen({octets, reply.content().size()});
  };
}

/// What must live as long as an asynchronous call.
struct InFlight {
  grpc::ClientContext context;
  Octets request;
  Octets reply;
  std::promise<grpc::Status> ended;
};

StartEcho start_of(const std::shared_ptr<rpc::Echo::Stub>& stub) {
  return [stub](const Content& content) {
    const auto call = std::make_shared<InFlight>();
    call->request = message_of(content);
    stub->async()->Call(&call->context, &call->request, &call->reply,
                        [call](grpc::Status status) { call->ended.set_value(std::move(status)); });
    return [call] { check(call->ended.get_future().get()); };
  };
}

void client(const Arguments& arguments) {
  const auto stub = make_stub(arguments);
  const EchoCall call = call_of(stub);
  call({}, [](auto) {});
  run_client({call, [&] { return call_of(make_stub(arguments)); }, start_of(stub)});
}

}  // namespace
}  // namespace skein::benchmarks::rivals

int main(int argc, char** argv) {
  using namespace skein::benchmarks::rivals;
  return rival_main(argc, argv, [](const Arguments& arguments) {
    arguments.role == "server" ? server(arguments) : client(arguments);
  });
}
