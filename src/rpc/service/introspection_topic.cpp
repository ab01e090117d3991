#include "rpc/service/introspection_topic.hpp"

#include <exception>
#include <string>

#include "core/log.hpp"

namespace skein::introspection {
namespace {

/// A reader that hangs must not hold up an entity's end for longer.
constexpr std::chrono::milliseconds kLastAcknowledgments{200};

}  // namespace

dds::Qos AnyTopic::qos() const {
  dds::Qos qos;
  qos.reliable = reliable;
  qos.history_depth = history_depth;
  return qos;
}

AnyPublisher::AnyPublisher(dds::Participant& participant, Executor& control, const AnyTopic& topic)
    : control_(control), topic_(topic) {
  dds::WriterListener listener;
  listener.on_matched = [this](const Guid&, bool matched) { on_reader(matched); };
  auto writer = rpc::SharedUse::share(
      participant.create_writer(topic.dds_topic(), topic.qos(), std::move(listener)),
      writers_.hold());
  std::lock_guard lock(mutex_);
  writer_ = std::move(writer);
  update();
}

void AnyPublisher::close() {
  std::shared_ptr<dds::Writer> writer;  // goes outside the lock, which its listener takes
  bool is_read = false;
  {
    std::lock_guard lock(mutex_);
    if (!writer_) return;
    is_read = on();
    writer.swap(writer_);
    update();
  }
  if (is_read && topic_.reliable) writer->wait_for_acknowledgments(kLastAcknowledgments);
  writer.reset();
  writers_.await_end();
}

void AnyPublisher::when_read(std::function<void()> begin) {
  std::lock_guard lock(mutex_);
  begin_ = std::move(begin);
  if (on()) hand_to_control(begin_);
}

void AnyPublisher::post(std::function<void()> task) {
  std::lock_guard lock(mutex_);
  if (writer_) hand_to_control(std::move(task));
}

void AnyPublisher::on_reader(bool matched) {
  std::lock_guard lock(mutex_);
  readers_ += matched ? 1 : -1;
  update();
  if (matched && writer_ && begin_) hand_to_control(begin_);
}

// Under the lock, after each change of readers_ or writer_.
void AnyPublisher::update() { on_ = writer_ && readers_ > 0; }

// Under the lock, and before it is closed: then `control` and writers_ may be gone. One task of a
// kind at a time, so that a full queue may take it: a clock's turn that is lost would not come
// back.
void AnyPublisher::hand_to_control(std::function<void()> task) {
  control_.post_or_run([hold = std::weak_ptr(writers_.hold()), task = std::move(task)] {
    if (const auto held = hold.lock()) task();
  });
}

std::shared_ptr<dds::Writer> AnyPublisher::open_writer() {
  std::lock_guard lock(mutex_);
  return writer_;
}

void AnyPublisher::log_not_sent(const Error& error) const {
  log(LogLevel::Warning, topic_.name, std::string("a sample was not sent: ") + error.what());
}

AnyReader::AnyReader(dds::Participant& participant, const AnyTopic& topic, Listener listener)
    : topic_(topic), listener_(std::move(listener)) {
  dds::ReaderListener port;
  port.on_data = [this](dds::Reader& reader) {
    reader.take([this](const dds::Sample& sample) { receive(sample); });
  };
  port.on_matched = [this](const Guid& writer, bool matched) {
    if (!matched && listener_.on_writer_gone) listener_.on_writer_gone(writer);
  };
  reader_ = participant.create_reader(topic.dds_topic(), topic.qos(), std::move(port));
}

void AnyReader::receive(const dds::Sample& sample) {
  try {
    listener_.on_sample(sample);
  } catch (const std::exception& error) {
    if (++refused_ > 1) return;
    log(LogLevel::Warning, topic_.name,
        "dropped a sample of participant " + sample.writer.participant().hex().substr(0, 24) +
            ": " + error.what() + "; further ones are counted and not logged");
  }
}

}  // namespace skein::introspection
