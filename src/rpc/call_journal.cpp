#include "skein/rpc/call_journal.hpp"

#include <chrono>

#include "skein/core/error.hpp"
#include "skein/core/interface_name.hpp"
#include "skein/core/log.hpp"
#include "skein/idl/codec.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::rpc {
namespace {

using introspection::CallEvent;

const dds::Topic kTopic{"skein/calls", "skein::introspection::CallEvent", false};

dds::Qos qos() {
  dds::Qos qos;
  qos.reliable = false;
  qos.history_depth = 256;
  return qos;
}

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

CallJournal::CallJournal(Executor& control, std::string entity)
    : control_(control), entity_(std::move(entity)) {}

CallJournal::~CallJournal() = default;

std::shared_ptr<CallJournal> CallJournal::open(dds::Participant& participant, Executor& control,
                                               std::string entity) {
  std::shared_ptr<CallJournal> journal(new CallJournal(control, std::move(entity)));
  dds::WriterListener listener;
  listener.on_matched = [weak = std::weak_ptr(journal)](const Guid&, bool matched) {
    if (const auto self = weak.lock()) self->on_reader(matched);
  };
  auto writer = SharedWriters::share(participant.create_writer(kTopic, qos(), std::move(listener)),
                                     journal->writers_.hold());
  std::lock_guard lock(journal->mutex_);
  journal->writer_ = std::move(writer);
  return journal;
}

void CallJournal::close() {
  std::shared_ptr<dds::Writer> writer;  // goes outside the lock, which its listener takes
  {
    std::lock_guard lock(mutex_);
    if (!writer_) return;
    on_ = false;
    readers_ = 0;
    writer.swap(writer_);
  }
  writer.reset();
  writers_.await_end();
}

void CallJournal::on_reader(bool matched) {
  std::lock_guard lock(mutex_);
  if (!matched && readers_ == 0) return;  // closed
  readers_ += matched ? 1 : -1;
  on_ = readers_ > 0;
}

void CallJournal::note_end(bool at_server, const Guid& client, std::uint64_t number,
                           std::string_view service, const OperationInfo& operation,
                           const std::exception_ptr& error) {
  using introspection::CallStep;
  if (!on()) return;
  if (error && !declared(error)) {
    record(at_server ? CallStep::Refused : CallStep::Failed, client, number, service, operation,
           error);
  } else {
    record(at_server ? CallStep::Replied : CallStep::Answered, client, number, service, operation,
           nullptr);
  }
}

void CallJournal::record(introspection::CallStep step, const Guid& client, std::uint64_t number,
                         std::string_view service, const OperationInfo& operation,
                         const std::exception_ptr& error) {
  CallEvent event;
  event.client = client.bytes;
  event.number = number;
  event.step = step;
  event.entity = entity_;
  event.service = scoped_interface_name(std::string(service));
  event.operation = operation.name;
  event.error = text_of(error);
  event.time = static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                              std::chrono::system_clock::now().time_since_epoch())
                                              .count());
  std::lock_guard lock(mutex_);
  if (events_.size() >= kCapacity) {
    ++dropped_;
    return;
  }
  events_.push_back(std::move(event));
  if (writing_ || !writer_) return;
  writing_ = control_.post([weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->write_all();
  });
}

void CallJournal::write_all() {
  std::vector<CallEvent> events;
  std::shared_ptr<dds::Writer> writer;
  std::uint64_t dropped;
  {
    std::lock_guard lock(mutex_);
    events.swap(events_);
    writer = writer_;
    dropped = dropped_;
    writing_ = false;
  }
  if (!writer) return;
  for (CallEvent& event : events) {
    event.dropped = dropped;
    try {
      writer->write(idl::encode_message(event));
    } catch (const Error& error) {
      log(LogLevel::Warning, kTopic.name, std::string("an event was not sent: ") + error.what());
    }
  }
}

CallJournalReader::CallJournalReader(dds::Participant& participant,
                                     std::function<void(const CallEvent&)> consumer) {
  dds::ReaderListener listener;
  listener.on_data = [consumer = std::move(consumer), &refused = refused_](dds::Reader& reader) {
    reader.take([&](const dds::Sample& sample) {
      if (sample.state != dds::InstanceState::Alive) return;
      CallEvent event;
      try {
        event = idl::decode_message<CallEvent>(sample.cdr);
      } catch (const std::exception& error) {
        if (++refused > 1) return;
        log(LogLevel::Warning, kTopic.name,
            "dropped a malformed sample of participant " +
                sample.writer.participant().hex().substr(0, 24) + ": " + error.what() +
                "; further ones are counted and not logged");
        return;
      }
      consumer(event);
    });
  };
  reader_ = participant.create_reader(kTopic, qos(), std::move(listener));
}

}  // namespace skein::rpc
