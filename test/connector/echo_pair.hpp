#pragma once

#include <memory>
#include <utility>

#include "echo_service.hpp"
#include "skein/entity.hpp"

namespace skein::test {

/// A provider of Echo and a client that is connected to it, each an entity of its own.
template <class Implementation = EchoService>
struct EchoPair {
  EchoPair(std::unique_ptr<Entity> server_, std::unique_ptr<Entity> client_,
           const ServiceOptions& options = {})
      : server(std::move(server_)),
        client(std::move(client_)),
        id(server->provide<::test::LouderEcho>(service, options)),
        echo(std::make_unique<::test::Echo::Proxy>(client->connect<::test::Echo>())) {}
  ~EchoPair() { echo.reset(); }

  std::shared_ptr<Implementation> service = std::make_shared<Implementation>();
  std::unique_ptr<Entity> server;
  std::unique_ptr<Entity> client;
  Guid id;
  std::unique_ptr<::test::Echo::Proxy> echo;
};

}  // namespace skein::test
