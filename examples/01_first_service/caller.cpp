#include <cstdio>

#include "greeter.idl.hpp"
#include "skein/entity.hpp"

int main(int argc, char** argv) {
  const char* vendor = argc > 1 ? argv[1] : "fastdds";
  skein::Entity guest({.name = "guest", .vendor = skein::dds::load_vendor(vendor)});
  auto greeter = guest.connect<greeting::IGreeter>();
  std::puts(greeter.greet("world").c_str());
}
