#include <cstdio>

#include "skein/navigation/planners.hpp"

int main() {
  for (const std::string& name : skein::navigation::planner_names()) std::puts(name.c_str());
}
