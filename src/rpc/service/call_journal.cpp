#include "rpc/service/call_journal.hpp"

#include <utility>

#include "core/system/interface_name.hpp"
#include "core/wall_clock.hpp"
#include "skein/error.hpp"

namespace skein::introspection {

std::size_t size_of(const CallEvent& event) {
  return sizeof event + event.entity.size() + event.service.size() + event.operation.size() +
         event.error.size();
}

}  // namespace skein::introspection

namespace skein::rpc {
namespace {

std::string text_of(const std::exception_ptr& error) {
  if (!error) return {};
  try {
    std::rethrow_exception(error);
  } catch (const Error& known) {
    return std::string(to_string(known.code())) + ": " + known.what();
  } catch (const std::exception& other) {
    return other.what();
  } catch (...) {
    return "something that is no std::exception";
  }
}

bool declared(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const UserException&) {
    return true;
  } catch (...) {
    return false;
  }
}

}  // namespace

CallJournal::CallJournal(dds::Participant& participant, Clock& clock, Executor& control,
                         std::string entity)
    : entity_(std::move(entity)),
      publisher_(participant, clock, control, introspection::kTopic<introspection::CallEvents>) {}

void CallJournal::note_end(bool at_server, const Guid& client, std::uint64_t number,
                           std::string_view service, const OperationInfo& operation,
                           const std::exception_ptr& error) {
  using introspection::CallStep;
  if (!on()) return;
  if (error && !declared(error)) {
    record(at_server ? CallStep::RepliedError : CallStep::EndedInError, client, number, service,
           operation, error);
  } else {
    record(at_server ? CallStep::Replied : CallStep::Answered, client, number, service, operation,
           nullptr);
  }
}

// The call must go on, told or not.
void CallJournal::record(introspection::CallStep step, const Guid& client, std::uint64_t number,
                         std::string_view service, const OperationInfo& operation,
                         const std::exception_ptr& error) noexcept try {
  introspection::CallEvent event;
  event.client = client.bytes;
  event.number = number;
  event.step = step;
  event.entity = entity_;
  event.service = scoped_interface_name(std::string(service));
  event.operation = operation.name;
  event.error = text_of(error);
  event.time = nanoseconds_since_1970();
  publisher_.publish(std::move(event));
} catch (const std::exception&) {  // no memory
}

}  // namespace skein::rpc
