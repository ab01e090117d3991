#pragma once

namespace skein::test {

/// Runs before all tests of a program; what is not 0 ends it as its exit code (77: skipped). A
/// program that needs something defines it anew.
int prepare();

}  // namespace skein::test
