#include "steady_waits.hpp"

#include <dds/dds.h>
#include <elf.h>
#include <link.h>
#include <pthread.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <string_view>

#include "core/log.hpp"

namespace skein::dds::cyclonedds {
namespace {

constexpr std::string_view kFunction = "pthread_cond_timedwait";
constexpr std::int64_t kSecond = 1'000'000'000;
/// A step between Cyclone's look at the clock and ours lengthens a wait to this, no more.
constexpr std::int64_t kLongestWait = kSecond;

std::int64_t now(clockid_t clock) {
  timespec time{};
  ::clock_gettime(clock, &time);
  return time.tv_sec * kSecond + time.tv_nsec;
}

/// As pthread_cond_timedwait() with a condition of the wall clock, which may wake without a reason.
int timed_wait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until) {
  const std::int64_t left = until->tv_sec * kSecond + until->tv_nsec - now(CLOCK_REALTIME);
  const std::int64_t end = now(CLOCK_MONOTONIC) + std::clamp<std::int64_t>(left, 0, kLongestWait);
  const timespec time{end / kSecond, end % kSecond};
  const int result = ::pthread_cond_clockwait(condition, mutex, CLOCK_MONOTONIC, &time);
  return result == ETIMEDOUT && left > kLongestWait ? 0 : result;
}

static_assert(sizeof(void*) == 8, "relocations as 64-bit machines have them");

/// A library in memory, as the dynamic linker has laid it out (ELF gABI, chapter 5).
class LoadedLibrary {
 public:
  explicit LoadedLibrary(const dl_phdr_info& info) : base_(info.dlpi_addr) {
    for (const auto* each = info.dlpi_phdr; each != info.dlpi_phdr + info.dlpi_phnum; ++each) {
      if (each->p_type == PT_DYNAMIC) read_dynamic(at<ElfW(Dyn)>(each->p_vaddr));
      if (each->p_type == PT_LOAD) end_ = std::max(end_, base_ + each->p_vaddr + each->p_memsz);
      if (each->p_type == PT_GNU_RELRO) protected_end_ = base_ + each->p_vaddr + each->p_memsz;
    }
  }

  bool contains(const void* address) const {
    const auto place = reinterpret_cast<std::uintptr_t>(address);
    return place >= base_ && place < end_;
  }

  /// Lets all its calls of the C function go to `replacement`; false where there are none.
  bool redirect(std::string_view function, void* replacement) const {
    for (const auto* each = imports_; each != imports_end_; ++each) {
      if (function != names_ + symbols_[ELF64_R_SYM(each->r_info)].st_name) continue;
      return write(at<void*>(each->r_offset), replacement);
    }
    return false;
  }

 private:
  template <class T>
  T* at(std::uintptr_t offset) const {
    // The linker has added the base to some pointers already, which depends on the architecture.
    return std::bit_cast<T*>(offset < base_ ? base_ + offset : offset);
  }

  void read_dynamic(const ElfW(Dyn) * entry) {
    std::size_t size = 0;
    for (; entry->d_tag != DT_NULL; ++entry) {
      if (entry->d_tag == DT_SYMTAB) symbols_ = at<const ElfW(Sym)>(entry->d_un.d_ptr);
      if (entry->d_tag == DT_STRTAB) names_ = at<const char>(entry->d_un.d_ptr);
      if (entry->d_tag == DT_JMPREL) imports_ = at<const ElfW(Rela)>(entry->d_un.d_ptr);
      if (entry->d_tag == DT_PLTRELSZ) size = entry->d_un.d_val;
    }
    imports_end_ = imports_ + size / sizeof *imports_;
  }

  /// The linker has made the table of addresses read-only, where it was told to.
  bool write(void** slot, void* value) const {
    const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const auto place = reinterpret_cast<std::uintptr_t>(slot);
    auto* const begin = std::bit_cast<void*>(place / page * page);
    if (::mprotect(begin, page, PROT_READ | PROT_WRITE) != 0) return false;
    __atomic_store_n(slot, value, __ATOMIC_RELEASE);
    if (place < protected_end_) ::mprotect(begin, page, PROT_READ);
    return true;
  }

  std::uintptr_t base_;
  std::uintptr_t end_ = 0;
  std::uintptr_t protected_end_ = 0;
  const ElfW(Sym) * symbols_ = nullptr;
  const char* names_ = nullptr;
  const ElfW(Rela) * imports_ = nullptr;
  const ElfW(Rela) * imports_end_ = nullptr;
};

int redirect_cyclone(dl_phdr_info* info, std::size_t, void*) {
  const LoadedLibrary library(*info);
  if (!library.contains(reinterpret_cast<const void*>(&dds_create_domain))) return 0;
  return library.redirect(kFunction, reinterpret_cast<void*>(&timed_wait)) ? 1 : -1;
}

}  // namespace

void wait_by_steady_clock() {
  if (::dl_iterate_phdr(redirect_cyclone, nullptr) > 0) return;
  log(LogLevel::Warning, "dds/cyclonedds",
      "this Cyclone DDS waits by the wall clock: where that is set back, its participants are "
      "silent for as long, and lost to others; set the clock before they start");
}

}  // namespace skein::dds::cyclonedds
