// The other floor: both sides spin on a shared page, nothing sleeps and nothing is encoded. Between
// turns the server dozes, so that it takes no core from other contenders.

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <new>
#include <thread>

#include "raw/main.hpp"

namespace skein::benchmarks::raw {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kGreatest = 1 << 20;
constexpr std::chrono::milliseconds kSpinning{5};

struct Slot {
  alignas(64) std::atomic<std::uint32_t> number{0};  ///< Of the message that lies here.
  std::uint32_t size = 0;
  std::uint8_t octets[kGreatest];
};

struct Shared {
  Slot request;
  Slot reply;
};

std::string name_of(std::uint32_t domain) { return "/skein-benchmark-" + std::to_string(domain); }

Shared* map(std::uint32_t domain, int flags) {
  const int file = shm_open(name_of(domain).c_str(), O_RDWR | flags, 0600);
  if (file < 0 || ftruncate(file, sizeof(Shared)) != 0)
    throw Internal("shared memory cannot be had");
  void* const memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (memory == MAP_FAILED) throw Internal("shared memory cannot be mapped");
  return static_cast<Shared*>(memory);
}

void put(Slot& slot, std::uint32_t number, const Content& content) {
  slot.size = static_cast<std::uint32_t>(content.size());
  std::memcpy(slot.octets, content.data(), content.size());
  slot.number.store(number, std::memory_order_release);
}

Content get(const Slot& slot) { return {slot.octets, slot.octets + slot.size}; }

void serve(Shared& shared, const std::atomic<bool>& ending) {
  SpinningPause pause;
  std::uint32_t answered = 0;
  while (!ending) {
    const std::uint32_t number = shared.request.number.load(std::memory_order_acquire);
    pause.after(number != answered);
    if (number == answered) continue;
    put(shared.reply, number, echo(get(shared.request)));
    answered = number;
  }
}

void server(const RawOptions& options, const std::function<void()>& meanwhile) {
  Shared* const shared = new (map(options.domain, O_CREAT | O_TRUNC)) Shared;
  std::atomic<bool> ending{false};
  std::thread thread([&] { serve(*shared, ending); });
  meanwhile();
  ending = true;
  thread.join();
  shm_unlink(name_of(options.domain).c_str());
}

void client(const RawOptions& options) {
  Shared& shared = *map(options.domain, 0);
  std::uint32_t number = 0;
  run_raw_client(
      [&](const Content& content, std::chrono::milliseconds patience) -> std::optional<Content> {
        const auto end = Clock::now() + patience;
        put(shared.request, ++number, content);
        while (shared.reply.number.load(std::memory_order_acquire) != number) {
          if (Clock::now() > end) return std::nullopt;
        }
        return get(shared.reply);
      });
}

}  // namespace
}  // namespace skein::benchmarks::raw

int main(int argc, char** argv) {
  using namespace skein::benchmarks::raw;
  return raw_main(argc, argv, server, client);
}
