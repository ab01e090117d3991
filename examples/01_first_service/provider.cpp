#include <cstdio>

#include "greeter.idl.hpp"
#include "skein/entity.hpp"
#include "skein/process.hpp"

class Greeter : public greeting::IGreeter {
  std::string greet(const std::string& name) override { return "Hello, " + name + "!"; }
};

int main(int argc, char** argv) {
  const char* vendor = argc > 1 ? argv[1] : "cyclonedds";
  skein::Entity host({.name = "host", .vendor = skein::dds::load_vendor(vendor)});
  host.provide<greeting::IGreeter>(std::make_shared<Greeter>());
  std::puts("Greeting whoever asks, until Ctrl-C.");
  skein::wait_for_signal();
}
