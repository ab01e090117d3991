#pragma once

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/head.hpp"

namespace skein::test {

/// The two vendors that a run pairs, from SKEIN_PAIRING, `server:client`. Ends the program as
/// skipped where one of them is not installed.
struct Pairing {
  std::shared_ptr<dds::Vendor> server;
  std::shared_ptr<dds::Vendor> client;

  static const Pairing& get() {
    static const Pairing pairing = load();
    return pairing;
  }

 private:
  static Pairing load() {
    const char* text = std::getenv("SKEIN_PAIRING");
    const std::string names = text ? text : "loopback:loopback";
    try {
      return {dds::load_vendor(names.substr(0, names.find(':'))),
              dds::load_vendor(names.substr(names.find(':') + 1))};
    } catch (const Unavailable& error) {
      std::fprintf(stderr, "skipped: %s\n", error.what());
      std::_Exit(77);
    }
  }
};

inline std::unique_ptr<Entity> make_entity(const std::string& name,
                                           std::shared_ptr<dds::Vendor> vendor,
                                           const std::string& system = "uav-1",
                                           std::shared_ptr<Process> process = nullptr,
                                           HeadOptions head = {}) {
  EntityOptions options;
  options.name = name;
  options.system = system;
  options.vendor = std::move(vendor);
  options.domain = 17;
  options.process = std::move(process);
  options.head = std::move(head);
  options.shared_memory_calls = std::getenv("SKEIN_SHARED_MEMORY_CALLS") != nullptr;
  return std::make_unique<Entity>(std::move(options));
}

inline std::unique_ptr<Entity> make_server(const std::string& name = "server") {
  return make_entity(name, Pairing::get().server);
}

inline std::unique_ptr<Entity> make_client(const std::string& name = "client") {
  return make_entity(name, Pairing::get().client);
}

}  // namespace skein::test
