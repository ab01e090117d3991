#include "recording/mcap/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "core/printable.hpp"
#include "core/system/passing_error.hpp"
#include "recording/mcap/record_reader.hpp"
#include "skein/error.hpp"

namespace skein::recording {
namespace {

constexpr std::size_t kPiece = std::size_t{64} << 10;

std::string refusal(const std::string& path, const std::string& why) {
  return "the recording '" + printable(path) + "' cannot be opened: " + why;
}

}  // namespace

InputFile::InputFile(std::string path)
    : path_(std::move(path)), file_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct ::stat status {};
  if (!file_ || ::fstat(file_.get(), &status) != 0) {
    const int error = errno;
    throw_for_file(error, refusal(path_, std::generic_category().message(error)));
  }
  if (!S_ISREG(status.st_mode)) throw InvalidArgument(refusal(path_, "it is no file"));
  size_ = static_cast<std::uint64_t>(status.st_size);
}

Bytes InputFile::read(std::uint64_t offset, std::uint64_t length) const {
  if (offset > size_ || length > size_ - offset) {
    throw MalformedRecord(std::to_string(length) + " bytes at " + std::to_string(offset) +
                          " are beyond the file's end");
  }
  Bytes bytes;
  bytes.resize(length);
  for (std::uint64_t done = 0; done < length;) {
    const auto count = ::pread(file_.get(), bytes.data() + done, length - done,
                               static_cast<::off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      throw MalformedRecord(count == 0 ? "the file has become shorter"
                                       : "the file cannot be read: " +
                                             std::generic_category().message(errno));
    }
    done += static_cast<std::uint64_t>(count);
  }
  return bytes;
}

std::span<const std::byte> InputWindow::at(std::uint64_t offset, std::size_t length) {
  length = std::min<std::uint64_t>(length, file_.size() - std::min(offset, file_.size()));
  if (offset < start_ || offset + length > start_ + piece_.size()) {
    const std::uint64_t left = file_.size() - std::min(offset, file_.size());
    piece_ = file_.read(std::min(offset, file_.size()),
                        std::min<std::uint64_t>(left, std::max(length, kPiece)));
    start_ = offset;
  }
  return std::span<const std::byte>(piece_).subspan(offset - start_, length);
}

}  // namespace skein::recording
