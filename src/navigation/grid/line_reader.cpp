#include "line_reader.hpp"

#include <cerrno>
#include <charconv>
#include <sstream>
#include <system_error>

#include "core/system/passing_error.hpp"
#include "skein/error.hpp"

namespace skein::navigation::grid {
namespace {

constexpr std::uintmax_t kLargest = std::uintmax_t{1} << 30;

}  // namespace

LineReader::LineReader(const std::filesystem::path& file) : file_(file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InvalidArgument(file.string() + ": cannot be read; does it exist, and is it a file?");
  }
  if (std::filesystem::file_size(file, error) > kLargest) {
    throw InvalidArgument(file.string() + ": is larger than 1 GiB, as no map and no scenarios are");
  }
  in_.open(file);
  if (in_) return;
  const int reason = errno;
  throw_for_file(reason,
                 file.string() + ": cannot be read: " + std::generic_category().message(reason));
}

bool LineReader::next() {
  ++number_;
  if (!std::getline(in_, line_)) {
    line_.clear();
    return false;
  }
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  return true;
}

bool LineReader::next_filled() {
  while (next()) {
    if (line_.find_first_not_of(" \t") != std::string::npos) return true;
  }
  return false;
}

std::vector<std::string> LineReader::words() const {
  std::istringstream in(line_);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

int LineReader::integer(const std::string& word) const {
  return number<int>(word, "a whole number of reasonable size");
}

double LineReader::real(const std::string& word) const { return number<double>(word, "a number"); }

void LineReader::refuse(const std::string& why) const {
  throw InvalidArgument(file_.string() + ":" + std::to_string(number_) + ": " + why);
}

template <class Number>
Number LineReader::number(const std::string& word, const char* kind) const {
  Number value{};
  const char* end = word.data() + word.size();
  const auto [stopped, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stopped != end) refuse("'" + word + "' is not " + kind);
  return value;
}

}  // namespace skein::navigation::grid
