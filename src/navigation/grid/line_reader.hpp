#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace skein::navigation::grid {

/// The lines of a text file, each with its number for messages. All refusals are InvalidArgument.
class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& file);

  /// False at the end.
  bool next();
  /// As next(), past empty lines.
  bool next_filled();

  const std::string& line() const { return line_; }
  std::vector<std::string> words() const;

  /// The number that `word` is; refuses everything else.
  int integer(const std::string& word) const;
  double real(const std::string& word) const;

  [[noreturn]] void refuse(const std::string& why) const;

 private:
  template <class Number>
  Number number(const std::string& word, const char* kind) const;

  std::filesystem::path file_;
  std::ifstream in_;
  std::string line_;
  int number_ = 0;
};

}  // namespace skein::navigation::grid
