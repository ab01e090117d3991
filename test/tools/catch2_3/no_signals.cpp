// In place of Catch2's own, which CATCH_CONFIG_NO_POSIX_SIGNALS leaves out in version 2: it
// installs no handlers of signals. DyingTest has some.
#include <catch2/internal/catch_fatal_condition_handler.hpp>

namespace Catch {

FatalConditionHandler::FatalConditionHandler() = default;
FatalConditionHandler::~FatalConditionHandler() = default;
void FatalConditionHandler::engage_platform() {}
void FatalConditionHandler::disengage_platform() noexcept {}

}  // namespace Catch
