#pragma once

#include "echo.idl.hpp"
#include "harness/peer.hpp"

namespace skein::benchmarks {

/// The service for peers that are called by nobody, or by echo() alone.
class PlainEcho final : public benchmark::Echo {
 public:
  Content echo(const Content& content) override { return benchmarks::echo(content); }
  void hold() override {}
  bool holding() override { return false; }
};

}  // namespace skein::benchmarks
