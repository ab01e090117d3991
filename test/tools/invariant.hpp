#pragma once

#include <catch2/catch.hpp>

/// CHECK for what may not be wrong once, however busy the machine is: a call lost, a call executed
/// twice, a wrong result, a table that contradicts the truth. run_tests.py knows a test that failed
/// by its name, and does not run that test again. The expression compares what is there already: an
/// exception in it counts as a broken invariant, too.
#define INVARIANT(...) \
  INTERNAL_CATCH_TEST("INVARIANT", Catch::ResultDisposition::ContinueOnFailure, __VA_ARGS__)
