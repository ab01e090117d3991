#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "skein/core/error.hpp"

namespace skein::navigation::grid {

/// The lines of a text file, each with its number for messages.
class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& file) : file_(file), in_(file) {
    if (!in_) throw InvalidArgument(file.string() + ": cannot be read; does it exist?");
  }

  /// False at the end.
  bool next() {
    ++number_;
    if (!std::getline(in_, line_)) return false;
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    return true;
  }

  /// As next(), past empty lines.
  bool next_filled() {
    while (next()) {
      if (line_.find_first_not_of(" \t") != std::string::npos) return true;
    }
    return false;
  }

  const std::string& line() const { return line_; }

  std::vector<std::string> words() const {
    std::istringstream in(line_);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
  }

  /// A whole number of `word`; refuses everything else.
  int integer(const std::string& word) const { return number<int>(word, "a whole number"); }
  double real(const std::string& word) const { return number<double>(word, "a number"); }

  [[noreturn]] void refuse(const std::string& why) const {
    throw InvalidArgument(file_.string() + ":" + std::to_string(number_) + ": " + why);
  }

 private:
  template <class Number>
  Number number(const std::string& word, const char* kind) const {
    std::istringstream in(word);
    Number value{};
    if (!(in >> value) || in.peek() != std::istringstream::traits_type::eof()) {
      refuse("'" + word + "' is not " + kind);
    }
    return value;
  }

  std::filesystem::path file_;
  std::ifstream in_;
  std::string line_;
  int number_ = 0;
};

}  // namespace skein::navigation::grid
