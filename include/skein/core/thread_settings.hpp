#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace skein {

/// How the system is asked to run a thread. The defaults ask for nothing.
struct ThreadSettings {
  enum class Scheduling {
    Normal,      ///< The system's own choice; `nice` weighs it.
    Fifo,        ///< SCHED_FIFO: before all normal threads, until it waits.
    RoundRobin,  ///< SCHED_RR: the same, in turn with others of its priority.
  };

  Scheduling scheduling = Scheduling::Normal;
  int priority = 0;              ///< With Fifo and RoundRobin: 1 (least) to 99.
  int nice = 0;                  ///< With Normal: -20 (most favoured) to 19.
  std::vector<unsigned> cpus{};  ///< Where it may run; empty: anywhere.
  /// How long an idle thread looks for work before it sleeps: a wake-up saved for a processor
  /// spent.
  std::chrono::microseconds spin{0};
};

/// Throws InvalidArgument, which names `owner`, for what can never work: a number out of its range,
/// a priority without a real-time policy, a CPU that this machine does not have.
void check(const ThreadSettings& settings, const std::string& owner);

/// Makes the calling thread run so. What the system refuses is logged as a warning with its remedy,
/// and the rest holds. `owner` is for messages.
void apply(const ThreadSettings& settings, const std::string& owner);

/// Keeps all memory of this process, present and future, out of the pager's hands; thread stacks
/// are then resident at their full size. False, with a warning that names the remedy, where the
/// system refuses or would let later allocations fail.
bool lock_memory();

}  // namespace skein
