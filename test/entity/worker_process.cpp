// A CSP in a process of its own, to be killed: worker_process VENDOR NAME OWNER [dies | answers].
// It says `ready`, then `inside` when it has begun to work, and never ends by itself; or it dies
// then, or answers.
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <string>

#include "scripted_worker.hpp"
#include "skein/entity.hpp"

using namespace skein;

namespace {

void say(const char* line) {
  std::puts(line);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string then = argc > 4 ? argv[4] : "";
  EntityOptions options;
  options.name = std::string(argv[2]) + "-host";
  options.system = "uav-1";
  options.vendor = dds::load_vendor(argv[1]);
  options.domain = 17;
  Entity entity(std::move(options));
  ServiceOptions declared;
  declared.attributes = {{"latency", "20"}, {"quality", "0.9"}};
  entity.provide_csp<crew::Worker>(
      argv[2], argv[3], std::make_shared<skein::test::ScriptedWorker>([&](const std::string& task) {
        say("inside");
        if (then == "dies") _exit(1);
        while (then != "answers") pause();
        return argv[2] + (" did " + task);
      }),
      declared);
  say("ready");
  for (std::string line; std::getline(std::cin, line);) {
  }
}
