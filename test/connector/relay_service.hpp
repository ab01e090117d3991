#pragma once

#include "relay.idl.hpp"
#include "skein/entity.hpp"

namespace skein::test {

/// Implements test::Relay by blocking calls from its only thread.
class RelayService : public ::test::Relay {
 public:
  explicit RelayService(Entity& entity) : entity_(entity) {}

  std::string pass_on(const std::vector<std::string>& path) override {
    const std::string& own = entity_.options().name;
    if (path.empty()) return own;
    auto next =
        entity_.connect<::test::Relay>({.name = path.front(), .timeout = std::chrono::seconds(20)});
    return own + " " +
           next.within(std::chrono::seconds(30)).pass_on({path.begin() + 1, path.end()});
  }

 private:
  Entity& entity_;
};

}  // namespace skein::test
