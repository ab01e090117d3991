#pragma once

#if __cplusplus < 202002L
#error "Skein needs C++20: compile with -std=c++20, or link skein::skein in CMake, which sees to it"
#endif

/// Version of the interface between generated code and these headers. The IDL compiler writes its
/// version into each header that it generates; a mismatch stops the compilation.
#define SKEIN_IDL_VERSION 9
