#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include "newcomers.hpp"
#include "skein/executor.hpp"

namespace skein::rpc {

/// Looks at newcomers on `control`, one a task, so that what else waits for it has its turn, too.
/// Thread-safe.
class Admissions : public std::enable_shared_from_this<Admissions> {
 public:
  using Admit = std::function<void(const Newcomer&)>;

  explicit Admissions(Executor& control) : control_(control) {}

  /// Calls `admit` on `control`, unless the newcomer leaves before; the same function for all.
  /// Returns false if there is no room. What is not taken here is repeated by its sender.
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
