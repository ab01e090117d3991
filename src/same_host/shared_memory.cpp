#include "shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "skein/error.hpp"

namespace skein::same_host {
namespace {

constexpr int kSizeSeals = F_SEAL_SHRINK | F_SEAL_GROW;

[[noreturn]] void refuse(const std::string& what) {
  throw Unavailable("no memory to share with the other process: " + what);
}

[[noreturn]] void refuse_for(const char* call) {
  refuse(std::string(call) + ": " + std::strerror(errno));
}

}  // namespace

SharedMemory SharedMemory::make(std::size_t size) {
  FileDescriptor descriptor(memfd_create("skein", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!descriptor) refuse_for("memfd_create");
  if (ftruncate(descriptor.get(), static_cast<off_t>(size)) != 0) refuse_for("ftruncate");
  if (fcntl(descriptor.get(), F_ADD_SEALS, kSizeSeals | F_SEAL_SEAL) != 0)
    refuse_for("F_ADD_SEALS");
  return {std::move(descriptor), size};
}

SharedMemory SharedMemory::map(FileDescriptor descriptor, std::size_t size) {
  const int seals = fcntl(descriptor.get(), F_GET_SEALS);
  if (seals < 0 || (seals & kSizeSeals) != kSizeSeals) {
    refuse("what the other process offers is not sealed: it could take it away in use");
  }
  struct stat status {};
  if (fstat(descriptor.get(), &status) != 0) refuse_for("fstat");
  if (static_cast<std::size_t>(status.st_size) != size) {
    refuse("the other process offers " + std::to_string(status.st_size) + " octets; " +
           std::to_string(size) + " are needed");
  }
  return {std::move(descriptor), size};
}

SharedMemory::SharedMemory(FileDescriptor descriptor, std::size_t size)
    : descriptor_(std::move(descriptor)), size_(size) {
  void* const mapped =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_.get(), 0);
  if (mapped == MAP_FAILED) refuse_for("mmap");
  data_ = static_cast<std::byte*>(mapped);
}

SharedMemory::~SharedMemory() {
  if (data_ != nullptr) munmap(data_, size_);
}

}  // namespace skein::same_host
