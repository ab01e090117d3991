// A worker that hangs when it is told to, one that does not, a desk in front of them, and a mission
// that tells the first to hang and waits until it works again.

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include "../tools/eventually.hpp"
#include "skein/core/abi.hpp"
#include "skein/entity/component_registry.hpp"
#include "skein/entity/entity.hpp"
#include "worker.idl.hpp"

namespace {

using namespace skein;
using namespace std::chrono_literals;

class Worker final : public crew::Worker {
 public:
  explicit Worker(std::string name) : name_(std::move(name)) {}

  std::string work(const std::string& task) override {
    if (name_ == "moody" && task.starts_with("stop")) raise(SIGSTOP);
    while (name_ == "moody" && task == "hang") pause();
    return name_ + " did " + task;
  }
  void improve(const std::string& task, StreamSink<std::string>& sink) override {
    sink.push(work(task));
  }

 private:
  const std::string name_;
};

class Desk final : public crew::Desk {
 public:
  explicit Desk(Head& head) : head_(head) {}
  std::string ask(const std::string& text) override {
    Task<crew::Worker, std::string> task;
    task.run = [&](crew::Worker::Proxy& worker, Duration) { return worker.work(text); };
    return head_.perform(task);
  }

 private:
  Head& head_;
};

void say(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

int upset_the_moody_one(Entity& entity, const ParameterValues&) {
  auto desk = entity.connect<crew::Desk>();
  const auto moody_works = [&] { return desk.within(5s).ask("it") == "moody did it"; };
  // Beyond its lease it is lost, not late.
  const std::pair<std::string, Duration> troubles[] = {
      {"hang", 1s}, {"stop", 1s}, {"stop beyond its lease", 60s}};
  for (const auto& [trouble, time] : troubles) {
    if (!test::eventually(moody_works)) return 1;
    say(desk.within(time).ask(trouble));
    if (!test::eventually(moody_works)) return 2;
    say("after " + trouble + " moody works again");
  }
  return 0;
}

ComponentRegistry::CspFactory worker(const std::string& name) {
  return [name](const ParameterValues&) {
    return std::make_shared<crew::Worker::Skeleton>(std::make_shared<Worker>(name));
  };
}

}  // namespace

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(skein::ComponentRegistry& registry) {
  registry.add_csp("moody", worker("moody"));
  registry.add_csp("sound", worker("sound"));
  registry.add_body("office", [](skein::Entity& entity, const skein::ParameterValues&) {
    return skein::ComponentRegistry::Body{
        std::make_shared<crew::Desk::Skeleton>(std::make_shared<Desk>(entity.head()))};
  });
  registry.add_mission("client", upset_the_moody_one);
}
