#include "dds/loopback/callback_queue.hpp"

#include <catch2/catch.hpp>
#include <future>
#include <string>

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::loopback;

namespace {

struct Stage {
  void post(const void* target, const std::string& name) {
    queue.post(target, [this, name] { ran += name; });
  }
  std::mutex mutex;
  CallbackQueue::Lock lock{mutex};
  CallbackQueue queue;
  std::string ran;
  int one = 0;
  int two = 0;
};

}  // namespace

TEST_CASE_METHOD(Stage, "callbacks run in order, without the lock") {
  post(&one, "a");
  queue.post(&two, [this] {
    const CallbackQueue::Lock free(mutex, std::try_to_lock);
    ran += free.owns_lock() ? "b" : "locked ";
  });
  post(&one, "c");
  queue.run(lock);
  CHECK(ran == "abc");
  CHECK(lock.owns_lock());
}

TEST_CASE_METHOD(Stage, "what a callback posts runs after those that waited already") {
  queue.post(&one, [this] {
    CallbackQueue::Lock inside(mutex);
    post(&one, "c");
    queue.run(inside);
    ran += queue.is_caller() ? "a" : "outside ";
  });
  post(&one, "b");
  queue.run(lock);
  CHECK(ran == "abc");
  CHECK_FALSE(queue.is_caller());
}

TEST_CASE_METHOD(Stage, "a callback may be posted again as soon as it runs") {
  bool queued = true;
  queue.post(
      &one, [&] { ran += queued ? "queued" : "free"; }, &queued);
  CHECK(queued);
  queue.run(lock);
  CHECK(ran == "free");
}

TEST_CASE_METHOD(Stage, "a dropped target's callbacks do not run, those of others do") {
  post(&one, "a");
  post(&two, "b");
  post(&one, "c");
  queue.drop(&one, lock);
  queue.run(lock);
  CHECK(ran == "b");
}

TEST_CASE_METHOD(Stage, "a callback that drops its own target does not wait for itself") {
  queue.post(&one, [this] {
    CallbackQueue::Lock inside(mutex);
    queue.drop(&one, inside);
    ran += "a";
  });
  post(&one, "b");
  queue.run(lock);
  CHECK(ran == "a");
}

TEST_CASE_METHOD(Stage, "to drop a target waits for its callback on another thread, for no other") {
  std::promise<void> running, go_on;
  queue.post(&one, [&] {
    running.set_value();
    go_on.get_future().wait();
    ran += "a";
  });
  lock.unlock();
  auto runs = std::async(std::launch::async, [&] {
    CallbackQueue::Lock there(mutex);
    queue.run(there);
  });
  running.get_future().wait();
  lock.lock();
  queue.drop(&two, lock);
  CHECK(ran.empty());
  go_on.set_value();
  queue.drop(&one, lock);
  CHECK(ran == "a");
  lock.unlock();
  runs.wait();
}
