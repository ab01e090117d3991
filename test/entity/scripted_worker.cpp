#include "scripted_worker.hpp"

#include <condition_variable>
#include <mutex>

namespace skein::test {

std::string ScriptedWorker::work(const std::string& task) {
  ++calls;
  ++inside;
  struct Leave {
    std::atomic<int>& inside;
    ~Leave() { --inside; }
  } const leave{inside};
  return script_(task);
}

void ScriptedWorker::improve(const std::string& task, StreamSink<std::string>& sink) {
  sink.push("draft of " + task);
  sink.push(work(task));
}

ScriptedWorker::Script answer_as(const std::string& name) {
  return [name](const std::string& task) { return name + " did " + task; };
}

struct Hang::State {
  std::mutex mutex;
  std::condition_variable changed;
  bool released = false;
};

std::shared_ptr<Hang::State> Hang::state() {
  if (!state_) state_ = std::make_shared<State>();
  return state_;
}

ScriptedWorker::Script Hang::script() {
  return [state = state()](const std::string&) {
    std::unique_lock lock(state->mutex);
    state->changed.wait(lock, [&] { return state->released; });
    return std::string("too late");
  };
}

void Hang::release() {
  const auto state = this->state();
  const std::lock_guard lock(state->mutex);
  state->released = true;
  state->changed.notify_all();
}

}  // namespace skein::test
