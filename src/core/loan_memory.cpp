#include "skein/detail/loan_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <unordered_map>

#include "core/system/file_descriptor.hpp"
#include "core/system/held_signal.hpp"
#include "skein/error.hpp"

namespace skein {
namespace {

[[noreturn]] void refuse_for(const char* call, std::size_t size) {
  throw Unavailable("no memory of " + std::to_string(size) + " octets to lend: " + call + ": " +
                    std::strerror(errno));
}

/// All that live in this process, by where they begin.
struct Registry {
  std::mutex mutex;
  std::unordered_map<const void*, std::weak_ptr<LoanMemory>> all;
  std::atomic<std::size_t> count{0};
};

// Never destroyed: a loan may outlive what is static.
Registry& registry() {
  static auto& one = *new Registry;
  return one;
}

}  // namespace

std::shared_ptr<LoanMemory> LoanMemory::make(std::size_t size) {
  FileDescriptor descriptor(memfd_create("skein-loan", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!descriptor) refuse_for("memfd_create", size);
  const auto grow = [&] { return ftruncate(descriptor.get(), static_cast<off_t>(size)); };
  if (within_file_size(grow) != 0) refuse_for("ftruncate", size);
  void* const data = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor.get(), 0);
  if (data == MAP_FAILED) refuse_for("mmap", size);
  // Whoever maps it from now on can read alone.
  constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE | F_SEAL_SEAL;
  if (fcntl(descriptor.get(), F_ADD_SEALS, kSeals) != 0) {
    const int error = errno;
    munmap(data, size);
    errno = error;
    refuse_for("F_ADD_SEALS", size);
  }
  std::shared_ptr<LoanMemory> made(new LoanMemory(descriptor.release(), data, size));
  std::lock_guard lock(registry().mutex);
  registry().all.insert_or_assign(data, made);
  ++registry().count;
  return made;
}

std::shared_ptr<LoanMemory> LoanMemory::find(const void* address) {
  Registry& known = registry();
  if (known.count == 0) return nullptr;
  std::lock_guard lock(known.mutex);
  const auto found = known.all.find(address);
  return found == known.all.end() ? nullptr : found->second.lock();
}

LoanMemory::LoanMemory(int descriptor, void* data, std::size_t size)
    : descriptor_(descriptor), data_(data), size_(size) {}

LoanMemory::~LoanMemory() {
  {
    std::lock_guard lock(registry().mutex);
    registry().all.erase(data_);
    --registry().count;
  }
  for (const auto& each : readers_) each->forget();
  munmap(data_, size_);
  close(descriptor_);
}

void LoanMemory::add(std::shared_ptr<Reader> reader) {
  std::lock_guard lock(mutex_);
  std::erase_if(readers_, [](const auto& each) { return !each->reads() && !each->may_return(); });
  readers_.push_back(std::move(reader));
}

bool LoanMemory::is_read() const {
  std::lock_guard lock(mutex_);
  return std::ranges::any_of(readers_, [](const auto& each) { return each->reads(); });
}

}  // namespace skein
