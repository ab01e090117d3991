#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "skein/error.hpp"

namespace skein::profile {

/// A place in a file that a person wrote. `line` and `column` count from 1, columns in characters
/// (not bytes); both are 0 where the whole file is meant.
struct SourcePosition {
  std::string file;
  int line = 0;
  int column = 0;

  bool operator==(const SourcePosition&) const = default;
};

enum class Severity {
  Note,     ///< Nothing is wrong; but something was not checked.
  Warning,  ///< The mission can run, but hardly does what was meant.
  Error,    ///< The file is refused, or the mission cannot run as described.
};

/// One thing that is wrong with a description, a dictionary or a profile.
struct Finding {
  Severity severity = Severity::Error;
  SourcePosition where;
  std::string problem;   ///< What is wrong, or was not checked: one clause without a full stop.
  std::string remedy;    ///< What to write instead; may be empty.
  bool passing = false;  ///< This machine lacks something that may come: no file is wrong.

  bool operator==(const Finding&) const = default;
};

/// `error`, `warning`, `note`.
std::string_view to_string(Severity severity) noexcept;

/// `file:line:column`, the form that editors turn into a link; `file` alone for a whole file.
std::string to_text(const SourcePosition& where);

/// `file:line:column: error: problem; remedy`, as compilers write it. Text that came from a file is
/// quoted, shortened and free of control characters, so that it cannot drive a terminal.
std::string to_text(const Finding& finding);

/// One line for each finding, each ended by a line break.
std::string to_text(const std::vector<Finding>& findings);

/// Whether one of them is an error; warnings and notes alone do not keep a mission from running.
bool has_errors(const std::vector<Finding>& findings);

/// A file was refused. The text of the exception is all of its findings, one a line.
class DescriptionError : public InvalidArgument {
 public:
  explicit DescriptionError(std::vector<Finding> findings);
  const std::vector<Finding>& findings() const noexcept { return findings_; }

 private:
  std::vector<Finding> findings_;
};

}  // namespace skein::profile
