#pragma once

#include <string>

#include "skein/types.idl.hpp"

namespace skein::recording {

struct RecordingIdl {
  std::string type;  ///< The name of the root type in the text.
  std::string text;
};

/// A schema of encoding `omgidl` by which viewers of recordings decode the messages of `root` as
/// they travelled: self-contained IDL in the part of the language that @foxglove/omgidl-parser
/// reads, of types that consist of the same bytes. README.md says what they look like there. Throws
/// InvalidArgument, with the reason, where no such types exist, and for a type system that makes no
/// sense; the recording then has a channel without schema.
RecordingIdl to_recording_idl(const types::TypeSystem& types, const std::string& root);

}  // namespace skein::recording
