#pragma once

#include <set>
#include <string>

#include "test/faults/journal.hpp"

namespace skein::test {

/// Holds the calls of a journal to what must be true of them, whatever happened to those who made
/// and executed them: each ended, as one of `outcomes`; none was executed twice; those that
/// succeeded were executed, those that were refused (Unavailable, Overloaded) were not, and none
/// was executed after its caller had been told TimedOut. (One that ended as Disconnected may be,
/// within its deadline: its outcome is unknown.) Prints a line with counts under the name of the
/// cell. Of calls that were executed after they had ended as TimedOut `max_late` are allowed.
void check_calls(const Journal& journal, const std::string& cell,
                 const std::set<std::string>& outcomes, int max_late);

}  // namespace skein::test
