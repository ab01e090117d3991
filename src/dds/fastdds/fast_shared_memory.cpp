#include "fast_shared_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/system/held_signal.hpp"
#include "core/system/trusted_users.hpp"

namespace skein::dds::fastdds {
namespace {

const std::string kFolder = "/dev/shm";

std::string in_brackets(int error) { return " (" + std::generic_category().message(error) + ")"; }

}  // namespace

SegmentsTurn::SegmentsTurn(bool needed) {
  if (!needed) return;
  const std::string path = kFolder + "/skein_turn_" + std::to_string(::getuid());
  file_ = FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
  struct stat status {};
  // Another user may hold the lock of his own file for ever.
  if (!file_ || ::fstat(file_.get(), &status) != 0 || !is_own_user(status.st_uid)) return;
  while (::flock(file_.get(), LOCK_EX) != 0 && errno == EINTR) {
  }
}

std::optional<std::string> lacks_room_for_segments() {
  const FileDescriptor file(::open(kFolder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  if (!file) return kFolder + " takes no files" + in_brackets(errno);
  const int error =
      within_file_size([&] { return ::posix_fallocate(file.get(), 0, kSegmentsInAll); });
  if (error == 0) return std::nullopt;
  return kFolder + " has no " + std::to_string(kSegmentsInAll >> 20) + " MiB left" +
         in_brackets(error);
}

}  // namespace skein::dds::fastdds
