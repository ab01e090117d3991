#include <unistd.h>

#include <cstdio>
#include <thread>

#include "commands.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity/entity.hpp"

namespace skein::command {
namespace {

struct Arguments {
  std::string vendor = "cyclonedds";
  std::uint32_t domain = 0;
  std::string interface;
  double seconds = 1;
};

void print(const Arguments& arguments) {
  EntityOptions options;
  options.name = "skein-services-" + std::to_string(getpid());
  options.system = "tools";
  options.vendor = dds::load_vendor(arguments.vendor);
  options.domain = arguments.domain;
  if (!arguments.interface.empty()) options.network.interfaces = {arguments.interface};
  Entity entity(std::move(options));
  std::this_thread::sleep_for(std::chrono::duration<double>(arguments.seconds));
  const auto services = entity.broker().all();
  for (const auto& service : services) {
    std::printf("%-40s %s/%s  pid %u  %s\n", service->service.c_str(), service->system.c_str(),
                service->entity.c_str(), service->pid, service->vendor.c_str());
    for (const auto& attribute : service->attributes) {
      std::printf("    %s = %s\n", attribute.name.c_str(), attribute.value.c_str());
    }
  }
  std::printf("%zu services on domain %u\n", services.size(), arguments.domain);
}

}  // namespace

void add_services(CLI::App& app, int& result) {
  auto* command = app.add_subcommand("services", "List what is provided on a domain now");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("--vendor", arguments->vendor, "fastdds or cyclonedds")->capture_default_str();
  command->add_option("--domain", arguments->domain, "DDS domain of the mission")->capture_default_str();
  command->add_option("--interface", arguments->interface, "Network interface; loopback by default");
  command->add_option("--wait", arguments->seconds, "Seconds to listen")->capture_default_str();
  command->callback([arguments, &result] {
    print(*arguments);
    result = 0;
  });
}

}  // namespace skein::command
