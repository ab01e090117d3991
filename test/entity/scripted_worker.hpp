#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "worker.idl.hpp"

namespace skein::test {

/// A CSP that does what the test says, and counts its calls.
class ScriptedWorker final : public crew::Worker {
 public:
  using Script = std::function<std::string(const std::string& task)>;
  explicit ScriptedWorker(Script script) : script_(std::move(script)) {}

  std::string work(const std::string& task) override;
  /// First `draft of TASK`, then what the script says.
  void improve(const std::string& task, StreamSink<std::string>& sink) override;

  std::atomic<int> calls{0};
  std::atomic<int> inside{0};

 private:
  Script script_;
};

/// Answers `NAME did TASK`.
ScriptedWorker::Script answer_as(const std::string& name);

/// Ignores every deadline until it is released; for as long as it lives, who waits for it hangs.
class Hang {
 public:
  ~Hang() { release(); }
  ScriptedWorker::Script script();
  void release();

 private:
  struct State;
  std::shared_ptr<State> state();
  std::shared_ptr<State> state_;
};

}  // namespace skein::test
