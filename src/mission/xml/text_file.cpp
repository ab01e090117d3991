#include "text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <vector>

#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "core/system/file_descriptor.hpp"
#include "core/system/passing_error.hpp"
#include "mission/xml/finding.hpp"

namespace skein::profile {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& problem,
                         const std::string& remedy = {}) {
  throw DescriptionError({Finding{Severity::Error, {file.string(), 0, 0}, problem, remedy}});
}

std::string reason() { return std::generic_category().message(errno); }

/// The file of that folder whose name is nearest, for a name that was misspelled.
std::string remedy_for_missing(const std::filesystem::path& file) {
  constexpr std::size_t kMaxCompared = 1000;
  const auto folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code error;
  std::vector<std::string> names;
  for (std::filesystem::directory_iterator entry(folder, error), end;
       !error && entry != end && names.size() < kMaxCompared; entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  if (error) return "check the path: its folder cannot be read";
  std::sort(names.begin(), names.end());
  const std::string near = suggestion(file.filename().string(), names);
  return "check the path" + (near.empty() ? "" : printable(near, near.size()));
}

// O_NONBLOCK: opening a named pipe must not wait for somebody to write.
FileDescriptor open_file(const std::filesystem::path& file) {
  return FileDescriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
}

}  // namespace

std::string read_text_file(const std::filesystem::path& file) {
  const FileDescriptor input = open_file(file);
  if (!input) {
    const int error = errno;
    if (is_passing(error)) throw Unavailable(file.string() + " cannot be opened: " + reason());
    refuse(file, "cannot be opened: " + reason(),
           error == ENOENT   ? remedy_for_missing(file)
           : error == EACCES ? "check its rights, and those of its folders"
                             : "check the path");
  }
  struct stat status {};
  if (::fstat(input.get(), &status) != 0) refuse(file, "cannot be examined: " + reason());
  if (S_ISDIR(status.st_mode)) refuse(file, "is a directory", "name a file in it");
  if (!S_ISREG(status.st_mode)) refuse(file, "is no regular file");
  const std::string too_large = "is larger than " + std::to_string(kLargestFile >> 20) + " MiB";
  if (static_cast<std::uintmax_t>(status.st_size) > kLargestFile) refuse(file, too_large);

  // One byte more than expected tells a file that grows while it is read.
  std::string text(static_cast<std::size_t>(status.st_size) + 1, '\0');
  std::size_t length = 0;
  while (length < text.size()) {
    const auto count = ::read(input.get(), text.data() + length, text.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(file, "cannot be read: " + reason());
    if (count == 0) break;
    length += static_cast<std::size_t>(count);
  }
  if (length == text.size()) refuse(file, "grew while it was read", "try again");
  text.resize(length);
  return text;
}

}  // namespace skein::profile
