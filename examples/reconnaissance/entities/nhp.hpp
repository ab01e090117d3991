#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "member.hpp"
#include "mission.idl.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"

namespace reconnaissance {

/// The non-human pilot, the mission's executive: knows how everybody is, and says what is possible.
class Nhp {
 public:
  Nhp(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  void hear(const recon::Health& health);
  void judge(Tick tick);
  /// What is wrong with one of the crew; empty if nothing is.
  std::string trouble_of(const std::string& name, Tick wanted) const;
  bool all_heard(Tick wanted) const;

  std::vector<std::string> crew_;
  mutable std::mutex mutex_;
  std::condition_variable heard_;
  std::map<std::string, recon::Health> health_;
  bool started_ = false;

  skein::Subscription<recon::Health> healths_;
  skein::Publisher<recon::MissionMode> mode_;
  Member member_;
};

}  // namespace reconnaissance
