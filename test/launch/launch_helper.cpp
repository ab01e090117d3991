// A launcher in a process of its own, for tests that send signals to it: each argument is the
// script of one child.
#include <cstdio>
#include <string>

#include "shell_mission.hpp"

int main(int count, char** arguments) {
  skein::launch::LaunchPlan plan;
  for (int i = 1; i < count; ++i) {
    plan.children.push_back(shell_child("child-" + std::to_string(i), arguments[i]));
    plan.children.back().rules.stop_timeout = std::chrono::milliseconds(500);
  }
  return skein::launch::Supervisor(plan).run().exit_code;
}
