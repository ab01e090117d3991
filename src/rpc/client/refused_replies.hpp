#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

#include "call_port/call_port.hpp"

namespace skein::rpc {

/// What came in place of a connection's replies. The first of each kind is logged. Thread-safe.
class RefusedReplies {
 public:
  RefusedReplies(std::string service, std::string peer)
      : service_(std::move(service)), peer_(std::move(peer)) {}

  /// what_came_malformed() also counts the malformed messages of this receiver. Call watch(nullptr)
  /// before you destroy it.
  void watch(const calls::Receiver* receiver);
  void note_malformed(const std::string& why);
  void note_forged(const Guid& sender);

  std::uint64_t malformed() const;
  std::uint64_t forged() const;
  /// To be appended to an error's text, for a caller that has waited in vain; empty if nothing was
  /// malformed.
  std::string what_came_malformed() const;

 private:
  const std::string service_;
  const std::string peer_;
  mutable std::mutex mutex_;
  const calls::Receiver* receiver_ = nullptr;
  std::uint64_t malformed_ = 0;
  std::uint64_t forged_ = 0;
  std::string first_malformed_;
};

}  // namespace skein::rpc
