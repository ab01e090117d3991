#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "echo.idl.hpp"
#include "pairing.hpp"

namespace skein::test {

/// An entity that trusts others, and is trusted, for so long that a busy machine makes nobody
/// suspect.
inline std::unique_ptr<Entity> make_trusted(const std::string& name,
                                            std::shared_ptr<dds::Vendor> vendor,
                                            std::shared_ptr<Process> process) {
  return std::make_unique<Entity>(EntityOptions{.name = name,
                                                .system = "uav-1",
                                                .vendor = std::move(vendor),
                                                .domain = 17,
                                                .process = std::move(process),
                                                .lease = std::chrono::seconds(20)});
}

/// 32 clients, which call without a pause until they are told to stop. Eight share an entity, and
/// all are in `process`, or each entity is in one of its own.
class ManyClients {
 public:
  using Echo = ::test::Echo;
  static constexpr int kEntities = 4;
  static constexpr int kOfEntity = 8;

  /// `call` makes one call, and throws where it fails; `number` is the client's.
  ManyClients(const ConnectOptions& options, const std::shared_ptr<Process>& process,
              std::function<void(Echo::Proxy& echo, int number)> call)
      : call_(std::move(call)) {
    for (int i = 0; i < kEntities; ++i) {
      entities_.push_back(
          make_trusted("client-" + std::to_string(i), Pairing::get().client, process));
      for (int j = 0; j < kOfEntity; ++j) {
        auto echo = entities_.back()->connect<Echo>(options).within(std::chrono::seconds(30));
        threads_.emplace_back([this, echo, j]() mutable { run(echo, j); });
      }
    }
  }
  ~ManyClients() { stop(); }

  void stop() {
    enough_ = true;
    for (std::thread& each : threads_) each.join();
    threads_.clear();
  }

  std::uint64_t calls() const noexcept { return calls_; }
  std::uint64_t errors() const noexcept { return errors_; }
  std::string first_error() const {
    std::lock_guard lock(mutex_);
    return first_error_;
  }

 private:
  void run(Echo::Proxy& echo, int number) {
    while (!enough_) {
      ++calls_;
      try {
        call_(echo, number);
      } catch (const std::exception& error) {
        ++errors_;
        std::lock_guard lock(mutex_);
        if (first_error_.empty()) first_error_ = error.what();
      }
    }
  }

  const std::function<void(Echo::Proxy& echo, int number)> call_;
  std::vector<std::unique_ptr<Entity>> entities_;
  std::vector<std::thread> threads_;
  std::atomic<bool> enough_{false};
  std::atomic<std::uint64_t> calls_{0};
  std::atomic<std::uint64_t> errors_{0};
  mutable std::mutex mutex_;
  std::string first_error_;
};

}  // namespace skein::test
