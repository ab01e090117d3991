#pragma once

/// The version of what generated code expects of these headers. The IDL compiler writes the version
/// that it generates for into each header; a mismatch stops the compilation.
#define SKEIN_IDL_VERSION 2
