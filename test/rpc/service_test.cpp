#include "rpc/service.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "../connector/echo_service.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

/// What a service asks, and what may go once the service is closed.
struct Owner {
  std::promise<void> asked;
  std::promise<void> closed;
  std::atomic<bool> awaited{false};

  void answer() {
    asked.set_value();
    awaited = closed.get_future().wait_for(50ms) == std::future_status::timeout;
  }
};

std::shared_ptr<rpc::Service> make_service(const rpc::Service::Options& options) {
  static ManualClock clock;
  static ManualExecutor executor;
  return std::make_shared<rpc::Service>(
      std::make_shared<::test::LouderEcho::Skeleton>(std::make_shared<skein::test::EchoService>()),
      executor, clock, options);
}

/// Answers within the operation.
class PromptDesk : public ::test::Desk::Deferred {
  void ask(const std::string& question, Reply<std::string> reply) override {
    reply.answer(question);
  }
  void divide(std::int32_t, std::int32_t, const std::string&,
              Reply<::test::Desk_divide_Out> reply) override {
    reply.answer({});
  }
  void touch(Reply<void> reply) override { reply.answer(); }
  void note(const std::string&) override {}
  void count_up(std::int32_t, StreamSink<std::int32_t>&) override {}
  void label(Reply<std::string> reply) override { reply.answer("desk"); }
  void label(const std::string&, Reply<void> reply) override { reply.answer(); }
};

const OperationInfo* operation_of(const rpc::Service& service, std::string_view name) {
  for (const OperationInfo& operation : service.interface_info().operations) {
    if (operation.name == name) return &operation;
  }
  return nullptr;
}

void refuse_self_wait(const rpc::Service& service) {
  rpc::Invocation invocation;
  invocation.chain = {service.id()};
  CHECK_THROWS_AS(service.refuse_self_wait(invocation), Unavailable);
}

}  // namespace

TEST_CASE("close() waits for what asks the service's owner") {
  Owner owner;
  rpc::Service::Options options;
  options.open = [&](const rpc::OpenRequest&) -> std::shared_ptr<Session> {
    owner.answer();
    return nullptr;
  };
  options.name_of = [&](const Guid&) {
    owner.answer();
    return std::string("owner");
  };
  const auto service = make_service(options);
  std::function<void()> ask;
  SECTION("for a session") {
    ask = [&] { service->open({}); };
  }
  SECTION("for a name") {
    ask = [&] { refuse_self_wait(*service); };
  }
  std::thread client(ask);
  owner.asked.get_future().wait();
  service->close();
  owner.closed.set_value();
  client.join();
  CHECK(owner.awaited);
}

TEST_CASE("a closed service asks its owner nothing") {
  rpc::Service::Options options;
  options.open = [&](const rpc::OpenRequest&) -> std::shared_ptr<Session> {
    FAIL("it was asked for a session");
    return nullptr;
  };
  options.name_of = [&](const Guid&) -> std::string {
    FAIL("it was asked for a name");
    return "";
  };
  const auto service = make_service(options);
  service->close();
  CHECK_THROWS_AS(service->open({}), Unavailable);
  refuse_self_wait(*service);
}

TEST_CASE("a service that is to finish waits for each answer, and then refuses what comes") {
  ManualClock clock;
  ManualExecutor executor;
  const auto service = std::make_shared<rpc::Service>(std::make_shared<PromptDesk>(), executor,
                                                      clock, rpc::Service::Options{});
  const auto finished = [&] { return service->finish(clock.now()); };
  int answers = 0;
  const auto invocation = std::make_shared<rpc::Invocation>();
  invocation->operation = operation_of(*service, GENERATE("touch", "note"));
  invocation->in = {invocation->operation->in->make(), invocation->operation->in->destroy};
  invocation->deadline = clock.now() + 1s;
  invocation->respond = [&](const void*, const std::exception_ptr&) {
    ++answers;
    CHECK_FALSE(finished());
  };
  service->leave();
  service->submit(invocation);
  CHECK_FALSE(finished());
  executor.run_all();
  CHECK(answers == 1);
  CHECK(finished());
  CHECK_THROWS_AS(service->submit(invocation), NotSent);
}
