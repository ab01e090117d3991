#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "skein/error.hpp"

namespace skein::c {

/// An object that may not be destroyed while a function uses it. Thread-safe.
template <class Object>
class Guarded {
 public:
  /// `name` is for messages: `entity`.
  Guarded(std::string name, std::unique_ptr<Object> object)
      : name_(std::move(name)), object_(std::move(object)) {}
  ~Guarded() { end(); }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;

  /// The object, which lives as long as this.
  class Use {
   public:
    explicit Use(Guarded& guarded) : guarded_(guarded) {}
    ~Use() {
      std::lock_guard lock(guarded_.mutex_);
      if (--guarded_.users_ == 0) guarded_.changed_.notify_all();
    }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Object& operator*() const noexcept { return *guarded_.object_; }
    Object* operator->() const noexcept { return guarded_.object_.get(); }

   private:
    Guarded& guarded_;
  };

  /// Throws InvalidArgument after end() has begun.
  Use use() {
    std::lock_guard lock(mutex_);
    if (ending_) throw InvalidArgument("the " + name_ + " was freed");
    ++users_;
    return Use(*this);
  }

  /// Lets nobody use it any more, waits for those that do, calls `before`, and destroys the object.
  /// A second one waits for the first.
  void end(const std::function<void()>& before = {}) {
    std::unique_lock lock(mutex_);
    if (std::exchange(ending_, true)) return changed_.wait(lock, [this] { return !object_; });
    changed_.wait(lock, [this] { return users_ == 0; });
    Object* const object = object_.get();
    lock.unlock();
    if (before) before();
    std::default_delete<Object>()(object);
    lock.lock();
    static_cast<void>(object_.release());
    changed_.notify_all();
  }

 private:
  const std::string name_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::unique_ptr<Object> object_;
  std::size_t users_ = 0;
  bool ending_ = false;
};

}  // namespace skein::c
