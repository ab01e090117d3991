#include "skein/entity/process.hpp"

namespace skein {

Process::Process() : Process(std::make_shared<SystemClock>()) {}

Process::Process(std::shared_ptr<Clock> clock) : clock_(std::move(clock)) {}

}  // namespace skein
