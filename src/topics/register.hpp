#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "skein/detail/topic_type.hpp"
#include "skein/topic_qos.hpp"

namespace skein::topics {

/// What a publisher or a subscription says of itself.
struct Endpoint {
  std::string name;
  TopicType type;
  TopicQos qos;
  bool publishes = false;
  std::size_t matched = 0;    ///< Of the other kind.
  std::uint64_t samples = 0;  ///< Published, or received.
  std::uint64_t dropped = 0;  ///< Of a subscription: replaced, expired or malformed.
  std::uint64_t missed_deadlines = 0;
};

/// The publishers and subscriptions of one entity. Thread-safe.
class Register {
 public:
  using Report = std::function<Endpoint()>;

  /// Takes its entry out when it goes; does nothing where there is none.
  class Entry {
   public:
    Entry() = default;
    Entry(Register* known, Report report);
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;
    ~Entry();

   private:
    Register* known_ = nullptr;
    std::uint64_t number_ = 0;
  };

  /// In the order in which they came.
  std::vector<Endpoint> endpoints() const;

 private:
  mutable std::mutex mutex_;  // held while a report runs, so that its endpoint does not go
  std::map<std::uint64_t, Report> reports_;
  std::uint64_t last_ = 0;
};

}  // namespace skein::topics
