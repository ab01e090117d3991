#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include "jsbsim/process.hpp"
#include "test/tools/places.hpp"

namespace skein::test {

/// JSBSim's program: that of this machine, or the one that `dev` has unpacked. Ends the test's
/// program as skipped where there is none.
inline std::string jsbsim_program() {
  for (const std::string& name : {project_file("build/jsbsim/JSBSim"), std::string("JSBSim")})
    if (const auto found = reconnaissance::find_program(name)) return found->string();
  std::fprintf(stderr, "skipped: there is no JSBSim (./dev test unpacks it)\n");
  std::_Exit(77);
}

}  // namespace skein::test
