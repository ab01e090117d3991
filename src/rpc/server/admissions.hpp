#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include "newcomers.hpp"
#include "skein/executor.hpp"

namespace skein::rpc {

/// Admits newcomers on `control`, one in each task, so that other tasks get their turn.
/// Thread-safe.
class Admissions : public std::enable_shared_from_this<Admissions> {
 public:
  using Admit = std::function<void(const Newcomer&)>;

  explicit Admissions(Executor& control) : control_(control) {}

  /// Calls `admit` on `control`, unless the newcomer leaves first. Pass the same function each
  /// time. Returns false if there is no room; the client then asks again.
  bool add(Newcomer newcomer, const Admit& admit);
  void note_left(const Guid& client);

 private:
  void look_later(const Admit& admit);
  void look(const Admit& admit);

  Executor& control_;
  std::mutex mutex_;
  Newcomers waiting_;
  bool looking_ = false;  // a task of `control` is about to look at them
};

}  // namespace skein::rpc
