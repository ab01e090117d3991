#pragma once
#include <string>

namespace skein::test {

/// The path of a file or folder of the project, which is named as from its root.
std::string project_file(const std::string& name);

/// The path of a file or folder of this build, which is named as from the build's root.
std::string built_file(const std::string& name);

/// The path of a program of this build.
std::string built_program(const std::string& name);

/// The path of a shared library of this build, which is named by its file: `libskein_loopback.so`.
std::string built_library(const std::string& name);

}  // namespace skein::test
