#pragma once

#include <latch>
#include <memory>
#include <utility>

namespace skein::rpc {

/// Lets the owner of senders or writers that other threads use, too, wait until the last of them is
/// gone: none may outlive its port. A thread holds the pointer for as long as it is inside one.
/// What the owner hands out it guards itself.
class SharedUse {
 public:
  class Alive {
   public:
    explicit Alive(std::shared_ptr<std::latch> gone) : gone_(std::move(gone)) {}
    ~Alive() { gone_->count_down(); }
    Alive(const Alive&) = delete;
    Alive& operator=(const Alive&) = delete;

   private:
    std::shared_ptr<std::latch> gone_;
  };
  using Hold = std::shared_ptr<const Alive>;

  /// For whoever is about to make one, or to use the owner: await_end() waits for it. Who
  /// may come too late for that keeps a weak pointer to it. Not after await_end().
  Hold hold() const { return alive_; }

  /// What await_end() waits for.
  template <class Used>
  static std::shared_ptr<Used> share(std::unique_ptr<Used> used, Hold hold) {
    return {used.release(), [hold = std::move(hold)](Used* ended) { delete ended; }};
  }

  /// Once, after the owner has let go of them; not by a thread that holds one.
  void await_end() {
    alive_.reset();
    gone_->wait();
  }

 private:
  std::shared_ptr<std::latch> gone_ = std::make_shared<std::latch>(1);
  Hold alive_ = std::make_shared<const Alive>(gone_);
};

}  // namespace skein::rpc
