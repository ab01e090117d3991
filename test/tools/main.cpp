#define CATCH_CONFIG_NO_POSIX_SIGNALS
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "dying_test.hpp"
#include "prepare.hpp"

int main(int count, char** arguments) {
  if (const int code = skein::test::prepare()) return code;
  return Catch::Session().run(count, arguments);
}
