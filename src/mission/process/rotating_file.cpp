#include "rotating_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "core/system/held_signal.hpp"

namespace skein::launch {

RotatingFile::RotatingFile(std::filesystem::path file, const Limits& limits)
    : file_(std::move(file)), limits_(limits) {}

/// `x.log`, `x.1.log`, ...
std::filesystem::path RotatingFile::numbered(std::size_t number) const {
  if (number == 0) return file_;
  const std::string name = file_.stem().string() + "." + std::to_string(number);
  return file_.parent_path() / (name + file_.extension().string());
}

/// The new file comes first: where there can be none, those that are kept stay where they are.
bool RotatingFile::rotate() {
  const auto fresh = file_.parent_path() / (file_.stem().string() + ".new");
  FileDescriptor descriptor(
      ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (!descriptor) return false;
  std::error_code ignored;  // there may be fewer files
  for (std::size_t number = limits_.files - 1; number > 0; --number)
    std::filesystem::rename(numbered(number - 1), numbered(number), ignored);
  if (::rename(fresh.c_str(), file_.c_str()) != 0) return false;
  descriptor_ = std::move(descriptor);
  size_ = 0;
  return true;
}

bool RotatingFile::write(std::string_view line) {
  std::string text(line);
  text += '\n';
  const bool full = size_ > 0 && size_ + text.size() > limits_.size;
  if ((!descriptor_ || full) && !rotate()) return false;
  for (std::string_view rest = text; !rest.empty();) {
    const auto written =
        within_file_size([&] { return ::write(descriptor_.get(), rest.data(), rest.size()); });
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    rest.remove_prefix(static_cast<std::size_t>(written));
    size_ += static_cast<std::uintmax_t>(written);
  }
  return true;
}

}  // namespace skein::launch
