#include "recording/mcap/output_file.hpp"

#include <fcntl.h>
#include <sys/statvfs.h>

#include <cerrno>
#include <system_error>

#include "core/system/held_signal.hpp"
#include "core/system/whole_file.hpp"
#include "skein/error.hpp"

namespace skein::recording {
namespace {

constexpr ::mode_t kReadableByAll = 0644;

std::string words(int error) { return std::generic_category().message(error); }

std::string free_space(int file) {
  struct ::statvfs system {};
  if (::fstatvfs(file, &system) != 0) return {};
  return "; its file system has " + std::to_string(system.f_bavail * system.f_frsize) +
         " bytes left";
}

}  // namespace

OutputFile::OutputFile(std::string path)
    : path_(std::move(path)),
      file_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kReadableByAll)) {
  if (file_) return;
  const int error = errno;
  throw WriteFailed("the recording '" + path_ + "' cannot be made: " + words(error) +
                    (error == EEXIST ? "; name another file, or remove that one"
                                     : "; name a file in a folder that may be written to"));
}

void OutputFile::append(std::span<const std::byte> piece) {
  for (std::size_t written = 0; written < piece.size();) {
    const auto count = within_file_size(
        [&] { return ::write(file_.get(), piece.data() + written, piece.size() - written); });
    if (count > 0) {
      written += static_cast<std::size_t>(count);
    } else if (count == 0 || errno != EINTR) {
      fail(count == 0 ? EIO : errno);
    }
  }
  size_ += piece.size();
}

/// What is no regular file has no disk.
void OutputFile::sync() {
  if (::fsync(file_.get()) != 0 && errno != EINVAL && errno != EROFS) fail(errno);
}

void OutputFile::fail(int error) {
  const std::string space = free_space(file_.get());
  std::string text = "the recording '" + path_ + "' ends at " + std::to_string(size_) +
                     " bytes: it cannot be written: " + words(error) + space;
  const auto end = static_cast<::off_t>(size_);
  if (::ftruncate(file_.get(), end) != 0 || ::lseek(file_.get(), end, SEEK_SET) != end) {
    text += "; its last piece could not be taken away: " + words(errno);
  }
  throw WriteFailed(text + "; what stands there can be read. Make room, or record elsewhere");
}

}  // namespace skein::recording
