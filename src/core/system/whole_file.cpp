#include "whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <optional>
#include <system_error>

#include "core/printable.hpp"
#include "file_descriptor.hpp"
#include "held_signal.hpp"
#include "passing_error.hpp"

namespace skein {
namespace {

constexpr ::mode_t kByUmask = 0666;
constexpr ::mode_t kPermissions = 07777;
/// What was left when the power failed is not many.
constexpr int kMostNew = 1000;

/// A file that is being written, in place of another in the end.
class Draft {
 public:
  Draft(const std::string& what, const std::filesystem::path& file)
      : what_(what), file_(file), target_(target_of(file)) {
    struct ::stat old {};
    if (::stat(target_.c_str(), &old) == 0) old_mode_ = old.st_mode;
    path_ = is_direct() ? target_ : std::filesystem::path(target_.string() + ".new");
  }
  ~Draft() {
    if (descriptor_ && !is_direct() && !in_place_) ::unlink(path_.c_str());
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  /// Whether there is something that no file can take the place of.
  bool is_direct() const { return old_mode_ && !S_ISREG(*old_mode_); }

  void open() {
    if (is_direct()) {
      descriptor_ = FileDescriptor(::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
    } else {
      open_new();
    }
    if (!descriptor_) refuse();
    if (old_mode_ && !is_direct()) ::fchmod(descriptor_.get(), *old_mode_ & kPermissions);
  }

  /// What cannot be opened without somebody noticing is only asked whether it could be.
  void try_to_open() {
    if (!is_direct()) return open();
    if (S_ISDIR(*old_mode_)) errno = EISDIR;
    if (S_ISDIR(*old_mode_) || ::access(path_.c_str(), W_OK) != 0) refuse();
  }

  void write(std::string_view content) {
    while (!content.empty()) {
      const auto count = within_file_size(
          [&] { return ::write(descriptor_.get(), content.data(), content.size()); });
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) fail("writing");
      content.remove_prefix(static_cast<std::size_t>(count));
    }
  }

  void put_in_place() {
    if (is_direct()) return;
    if (::fsync(descriptor_.get()) != 0) fail("bringing to the disk");
    if (::rename(path_.c_str(), target_.c_str()) != 0) fail("renaming");
    in_place_ = true;
    // Its name is brought to the disk, too, where the file system can.
    const auto parent = target_.parent_path();
    const FileDescriptor folder(
        ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder) ::fsync(folder.get());
  }

 private:
  /// None that is there already, which may be somebody's.
  void open_new() {
    const std::string first = path_.string();
    for (int number = 2; number < kMostNew; ++number) {
      constexpr int kHow = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOCTTY;
      descriptor_ = FileDescriptor(::open(path_.c_str(), kHow, kByUmask));
      if (descriptor_ || errno != EEXIST) return;
      path_ = first + "-" + std::to_string(number);
    }
  }

  static std::filesystem::path target_of(const std::filesystem::path& file) {
    std::error_code error;
    const auto target = std::filesystem::canonical(file, error);
    return error ? file : target;
  }

  std::string told(const std::string& step) const {
    const std::string reason = std::generic_category().message(errno);
    return what_ + " '" + printable(file_.string()) + "' cannot be written: " + step + " '" +
           printable(path_.string()) + "': " + reason;
  }

  [[noreturn]] void refuse() const {
    if (is_passing(errno)) fail("opening");
    throw InvalidArgument(told("opening") + "; name a file in a folder that may be written to");
  }
  [[noreturn]] void fail(const char* step) const { throw WriteFailed(told(step)); }

  const std::string& what_;
  const std::filesystem::path& file_;
  const std::filesystem::path target_;
  std::optional<::mode_t> old_mode_;
  std::filesystem::path path_;
  bool in_place_ = false;
  FileDescriptor descriptor_;
};

}  // namespace

void write_whole_file(const std::string& what, const std::filesystem::path& file,
                      std::string_view content) {
  Draft draft(what, file);
  draft.open();
  draft.write(content);
  draft.put_in_place();
}

std::string read_whole_file(const std::string& what, const std::filesystem::path& file,
                            std::size_t largest) {
  const auto refuse = [&](const std::string& reason, int error = 0) {
    throw_for_file(error, what + " '" + printable(file.string()) + "' cannot be read: " + reason);
  };
  const auto fail = [&] { refuse(std::generic_category().message(errno), errno); };
  // O_NONBLOCK: opening a pipe must not wait for a writer.
  const FileDescriptor input(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct ::stat status {};
  if (!input || ::fstat(input.get(), &status) != 0) fail();
  if (!S_ISREG(status.st_mode)) refuse("it is no regular file");
  std::string text;
  std::array<char, 64 * 1024> piece;
  while (true) {
    const auto count = ::read(input.get(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail();
    if (count == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(count));
    if (text.size() > largest) {
      refuse("it has more than " + std::to_string(largest >> 20) + " MiB, and is another file");
    }
  }
}

void try_whole_file(const std::string& what, const std::filesystem::path& file) {
  Draft draft(what, file);
  draft.try_to_open();
}

}  // namespace skein
