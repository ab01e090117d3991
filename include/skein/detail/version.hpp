#pragma once

/// Version of the interface between generated code and these headers. The IDL compiler writes its
/// version into each header that it generates; a mismatch stops the compilation.
#define SKEIN_IDL_VERSION 4
