// An entity with a relay: VENDOR NAME. It says `ready`, and ends with its standard input.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include "relay_service.hpp"

int main(int count, char** given) {
  if (count != 3) return 2;
  skein::EntityOptions options;
  options.vendor = skein::dds::load_vendor(given[1]);
  options.name = given[2];
  options.system = "uav-1";
  options.domain = 17;
  options.shared_memory_calls = std::getenv("SKEIN_SHARED_MEMORY_CALLS") != nullptr;
  skein::Entity entity(std::move(options));
  entity.provide<test::Relay>(std::make_shared<skein::test::RelayService>(entity));
  std::cout << "ready" << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
  }
  return 0;
}
