// A launcher in a process of its own, for tests that send signals to it: each argument is the
// script of one child. STOP_TIMEOUT_MS is the time that they have to end in order.
#include <cstdlib>
#include <string>

#include "shell_mission.hpp"

int main(int count, char** arguments) {
  skein::launch::LaunchPlan plan;
  const char* const given = std::getenv("STOP_TIMEOUT_MS");
  const std::chrono::milliseconds stop_timeout(given ? std::stol(given) : 500);
  for (int i = 1; i < count; ++i) {
    plan.children.push_back(shell_child("child-" + std::to_string(i), arguments[i]));
    plan.children.back().rules.stop_timeout = stop_timeout;
  }
  return skein::launch::Supervisor(plan).run().exit_code;
}
