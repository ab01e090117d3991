#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "skein/error.hpp"

namespace skein {

/// What was to be written to a file is not there, or not all of it: a full disk, say.
class WriteFailed : public Unavailable {
 public:
  using Unavailable::Unavailable;
};

/// Writes a file whole: beside it at first (`FILE.new`, with a number if that is there), then to
/// the disk, then in its place. A reader finds the old content or the new one, after a loss of
/// power, too. What is no regular file, such as a terminal or a pipe, is written directly; a link
/// is followed. Errors name `what` it is ("the picture"), the file, the step and the system's
/// reason: InvalidArgument where it cannot be made, WriteFailed where that may pass (is_passing())
/// or fails later, which leaves the old file as it was.
void write_whole_file(const std::string& what, const std::filesystem::path& file,
                      std::string_view content);

/// The bytes of a file of at most `largest` bytes. A device or a pipe is refused before it is read:
/// one may be without end, the other wait for ever. Throws InvalidArgument, as write_whole_file(),
/// or Unavailable if the machine lacks something for the moment.
std::string read_whole_file(const std::string& what, const std::filesystem::path& file,
                            std::size_t largest);

/// For those who will write the file later: throws as write_whole_file() would now. Changes
/// nothing.
void try_whole_file(const std::string& what, const std::filesystem::path& file);

/// Runs `write`, which writes a file that a person has named as output: that it cannot even be made
/// is output that is lost, too, WriteFailed in place of InvalidArgument.
template <class Write>
void write_output(const Write& write) {
  try {
    write();
  } catch (const InvalidArgument& error) {
    throw WriteFailed(error.what());
  }
}

}  // namespace skein
