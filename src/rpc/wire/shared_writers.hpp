#pragma once

#include <latch>
#include <memory>
#include <utility>

#include "dds/port/port.hpp"

namespace skein::rpc {

/// Lets the owner of writers that other threads use, too, wait until the last of them is gone: no
/// writer may outlive its participant. A thread holds the pointer for as long as it is inside the
/// writer. What the owner hands out it guards itself.
class SharedWriters {
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

  /// For whoever is about to create a writer, or to use the owner: await_end() waits for it. Who
  /// may come too late for that keeps a weak pointer to it. Not after await_end().
  Hold hold() const { return alive_; }

  /// The writer, which await_end() waits for.
  static std::shared_ptr<dds::Writer> share(std::unique_ptr<dds::Writer> writer, Hold hold) {
    return {writer.release(), [hold = std::move(hold)](dds::Writer* ended) { delete ended; }};
  }

  /// Once, after the owner has let go of its writers; not by a thread that holds one.
  void await_end() {
    alive_.reset();
    gone_->wait();
  }

 private:
  std::shared_ptr<std::latch> gone_ = std::make_shared<std::latch>(1);
  Hold alive_ = std::make_shared<const Alive>(gone_);
};

}  // namespace skein::rpc
