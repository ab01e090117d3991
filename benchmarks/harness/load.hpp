#pragma once

#include "harness/peer.hpp"

namespace skein::benchmarks {

/// The ways in which a client calls, as commands; see run_client.
class Load {
 public:
  explicit Load(const Client& client) : client_(client) {}

  Commands commands();

 private:
  std::string one_by_one(const std::string& what);
  std::string paced(const std::string& what);
  std::string crowd(const std::string& what);
  std::string pipelined(const std::string& what);
  std::string idle(const std::string& what);

  /// So many clients, each with a connection of its own; the program's first client is one of them.
  std::vector<const EchoCall*> clients(std::size_t count);
  Content next_content(std::size_t size);

  const Client& client_;
  std::vector<EchoCall> others_;
  std::size_t turn_ = 0;
};

}  // namespace skein::benchmarks
