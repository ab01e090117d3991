#include "shared_memory.hpp"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/vfs.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/system/held_signal.hpp"
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

// Throws where they are not what `wanted` says.
std::size_t checked_size(const FileDescriptor& descriptor, int wanted) {
  const int seals = fcntl(descriptor.get(), F_GET_SEALS);
  if (seals < 0 || (seals & wanted) != wanted) {
    refuse("what the other process offers is not sealed: it could take it away in use");
  }
  // A large page that is not there when it is read ends who reads it.
  struct statfs system {};
  if (fstatfs(descriptor.get(), &system) != 0) refuse_for("fstatfs");
  if (system.f_type != TMPFS_MAGIC) refuse("what the other process offers is no ordinary memory");
  struct stat status {};
  if (fstat(descriptor.get(), &status) != 0) refuse_for("fstat");
  return static_cast<std::size_t>(status.st_size);
}

}  // namespace

SharedMemory SharedMemory::make(std::size_t size) {
  FileDescriptor descriptor(memfd_create("skein", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!descriptor) refuse_for("memfd_create");
  const auto grow = [&] { return ftruncate(descriptor.get(), static_cast<off_t>(size)); };
  if (within_file_size(grow) != 0) refuse_for("ftruncate");
  if (fcntl(descriptor.get(), F_ADD_SEALS, kSizeSeals | F_SEAL_SEAL) != 0)
    refuse_for("F_ADD_SEALS");
  return {std::move(descriptor), size, PROT_READ | PROT_WRITE};
}

SharedMemory SharedMemory::map(HandedOver descriptor, std::size_t size) {
  const std::size_t offered = checked_size(descriptor, kSizeSeals);
  if (offered != size) {
    refuse("the other process offers " + std::to_string(offered) + " octets; " +
           std::to_string(size) + " are needed");
  }
  return {std::move(descriptor), size, PROT_READ | PROT_WRITE};
}

SharedMemory SharedMemory::map_to_read(HandedOver descriptor, std::size_t largest) {
  const std::size_t offered = checked_size(descriptor, kSizeSeals | F_SEAL_FUTURE_WRITE);
  if (offered == 0 || offered > largest) {
    refuse("the other process offers " + std::to_string(offered) + " octets; up to " +
           std::to_string(largest) + " are taken");
  }
  return {std::move(descriptor), offered, PROT_READ};
}

SharedMemory::SharedMemory(FileDescriptor descriptor, std::size_t size, int access)
    : descriptor_(std::move(descriptor)), size_(size) {
  void* const mapped = mmap(nullptr, size, access, MAP_SHARED, descriptor_.get(), 0);
  if (mapped == MAP_FAILED) refuse_for("mmap");
  data_ = static_cast<std::byte*>(mapped);
}

SharedMemory::~SharedMemory() {
  if (data_ != nullptr) munmap(data_, size_);
}

}  // namespace skein::same_host
