// A call written with Fast DDS's own API, in the way that a careful user writes one, with the
// transport of Skein's back end: no code of the user's on Fast DDS's threads but a notification.

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <mutex>
#include <thread>

#include "raw/main.hpp"
#include "raw/message.hpp"

namespace skein::benchmarks::raw {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::Duration_t;

/// What data sharing reserves for each sample, and how many samples it reserves.
constexpr std::uint32_t kGreatestMessage = (1 << 20) + 64;
constexpr std::int32_t kSharedSamples = 8;

class MessageType final : public dds::TopicDataType {
 public:
  explicit MessageType(Way way) : bounded_(way == Way::DataSharing) {
    setName(kType);
    m_typeSize = bounded_ ? kGreatestMessage : 512;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& message = *static_cast<const Outgoing*>(data);
    encode(message, reinterpret_cast<char*>(payload->data));
    payload->length = static_cast<std::uint32_t>(encoded_size(message));
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    decode(*static_cast<Message*>(data), reinterpret_cast<char*>(payload->data), payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return
        [data] { return static_cast<std::uint32_t>(encoded_size(*static_cast<Outgoing*>(data))); };
  }
  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
  bool is_bounded() const override { return bounded_; }

 private:
  const bool bounded_;
};

rtps::Locator_t loopback() {
  rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(locator, "127.0.0.1");
  locator.port = 0;
  return locator;
}

template <class Endpoint>
void fill(Endpoint& qos, Way way) {
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_ALL_HISTORY_QOS;
  qos.resource_limits().max_samples = 0;
  qos.resource_limits().max_instances = 0;
  qos.resource_limits().max_samples_per_instance = 0;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
  if (way != Way::DataSharing) return;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = kSharedSamples;
  qos.resource_limits().max_samples = kSharedSamples;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = kSharedSamples;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_MEMORY_MODE;
  qos.data_sharing().automatic();
}

/// Segments that hold the fragments of some mebibytes; the default's half a mebibyte loses them.
std::shared_ptr<eprosima::fastdds::rtps::SharedMemTransportDescriptor> shared_memory() {
  auto memory = std::make_shared<eprosima::fastdds::rtps::SharedMemTransportDescriptor>();
  memory->segment_size(16 << 20);
  return memory;
}

class Participant {
 public:
  explicit Participant(std::uint32_t domain, Way way) : way_(way) {
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList = {"127.0.0.1"};
    udp->sendBufferSize = 64 << 20;
    udp->receiveBufferSize = 4 << 20;
    udp->maxInitialPeersRange = 4;
    dds::DomainParticipantQos qos;
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    if (way == Way::SharedMemory) qos.transport().user_transports.push_back(shared_memory());
    auto& builtin = qos.wire_protocol().builtin;
    builtin.avoid_builtin_multicast = true;
    builtin.initialPeersList.push_back(loopback());
    builtin.discovery_config.leaseDuration = Duration_t(1, 0);
    builtin.discovery_config.leaseDuration_announcementperiod = Duration_t(0, 250'000'000);
    builtin.discovery_config.initial_announcements = {5, Duration_t(0, 10'000'000)};
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
    if (participant_ == nullptr) throw Internal("no Fast DDS participant");
    dds::TypeSupport(new MessageType(way)).register_type(participant_);
    publisher_ = participant_->create_publisher(dds::PublisherQos());
    subscriber_ = participant_->create_subscriber(dds::SubscriberQos());
  }

  dds::DataWriter* writer(const char* topic) {
    dds::DataWriterQos qos;
    fill(qos, way_);
    qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
    qos.reliable_writer_qos().times.heartbeatPeriod = Duration_t(0, 100'000'000);
    qos.reliable_writer_qos().times.nackResponseDelay = Duration_t(0, 0);
    qos.reliable_writer_qos().times.nackSupressionDuration = Duration_t(0, 10'000'000);
    return publisher_->create_datawriter(participant_->create_topic(topic, kType, dds::TopicQos()),
                                         qos);
  }

  dds::DataReader* reader(const char* topic, dds::DataReaderListener* listener = nullptr) {
    dds::DataReaderQos qos;
    fill(qos, way_);
    qos.reliable_reader_qos().times.initialAcknackDelay = Duration_t(0, 10'000'000);
    qos.reliable_reader_qos().times.heartbeatResponseDelay = Duration_t(0, 0);
    return subscriber_->create_datareader(
        participant_->create_topic(topic, kType, dds::TopicQos()), qos, listener,
        listener ? dds::StatusMask::data_available() : dds::StatusMask::none());
  }

 private:
  const Way way_;
  dds::DomainParticipant* participant_;
  dds::Publisher* publisher_;
  dds::Subscriber* subscriber_;
};

/// Answers all requests that wait; whether there were any.
bool answer(dds::DataReader& requests, dds::DataWriter& replies) {
  bool answered = false;
  Message request;
  dds::SampleInfo info;
  while (requests.take_next_sample(&request, &info) ==
         eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
    if (!info.valid_data) continue;
    const Content result = echo(request.content);
    Outgoing reply{request.head, &result};
    replies.write(&reply);
    answered = true;
  }
  return answered;
}

class AnsweringListener final : public dds::DataReaderListener {
 public:
  explicit AnsweringListener(dds::DataWriter& replies) : replies_(replies) {}
  void on_data_available(dds::DataReader* requests) override { answer(*requests, replies_); }

 private:
  dds::DataWriter& replies_;
};

void serve(dds::DataReader& requests, dds::DataWriter& replies, Way way,
           const std::atomic<bool>& ending) {
  dds::WaitSet waiting;
  dds::StatusCondition& data = requests.get_statuscondition();
  data.set_enabled_statuses(dds::StatusMask::data_available());
  waiting.attach_condition(data);
  SpinningPause pause;
  while (!ending) {
    dds::ConditionSeq active;
    if (way != Way::Polling) waiting.wait(active, Duration_t(0, 100'000'000));
    const bool answered = answer(requests, replies);
    if (way == Way::Polling) pause.after(answered);
  }
}

Way way_of(const RawOptions& options) {
  return parse_way(options.way, {{"shared_memory", Way::SharedMemory},
                                 {"data_sharing", Way::DataSharing},
                                 {"listener", Way::Listener},
                                 {"polling", Way::Polling}});
}

void server(const RawOptions& options, const std::function<void()>& meanwhile) {
  const Way way = way_of(options);
  Participant participant(options.domain, way);
  dds::DataWriter* replies = participant.writer(kReplyTopic);
  if (way == Way::Listener) {
    static AnsweringListener listener(*replies);
    participant.reader(kRequestTopic, &listener);
    return meanwhile();
  }
  dds::DataReader* requests = participant.reader(kRequestTopic);
  std::atomic<bool> ending{false};
  std::thread thread([&] { serve(*requests, *replies, way, ending); });
  meanwhile();
  ending = true;
  thread.join();
}

class Client final : private dds::DataReaderListener {
 public:
  explicit Client(const RawOptions& options)
      : way_(way_of(options)),
        participant_(options.domain, way_),
        requests_(participant_.writer(kRequestTopic)),
        replies_(participant_.reader(kReplyTopic, way_ == Way::Polling ? nullptr : this)) {
    std::memcpy(id_.data(), &requests_->guid(), id_.size());
  }

  std::optional<Content> call(const Content& content, std::chrono::milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    Outgoing request{{id_, ++number_}, &content};
    requests_->write(&request);
    do {
      if (auto reply = take()) return reply;
    } while (await_data(end));
    return std::nullopt;
  }

 private:
  /// The reply, where it has come.
  std::optional<Content> take() {
    Message reply;
    dds::SampleInfo info;
    while (replies_->take_next_sample(&reply, &info) ==
           eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (info.valid_data && reply.head.client == id_ && reply.head.number == number_) {
        return std::move(reply.content);
      }
    }
    return std::nullopt;
  }

  bool await_data(std::chrono::steady_clock::time_point end) {
    if (way_ == Way::Polling) return std::chrono::steady_clock::now() < end;
    std::unique_lock lock(mutex_);
    const bool arrived = changed_.wait_until(lock, end, [&] { return arrived_; });
    arrived_ = false;
    return arrived;
  }

  void on_data_available(dds::DataReader*) override {
    std::lock_guard lock(mutex_);
    arrived_ = true;
    changed_.notify_one();
  }

  const Way way_;
  Participant participant_;
  dds::DataWriter* requests_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool arrived_ = false;
  ClientId id_{};
  std::uint32_t number_ = 0;
  dds::DataReader* replies_;
};

void client(const RawOptions& options) {
  Client client(options);
  run_raw_client([&](const Content& content, std::chrono::milliseconds patience) {
    return client.call(content, patience);
  });
}

}  // namespace
}  // namespace skein::benchmarks::raw

int main(int argc, char** argv) {
  using namespace skein::benchmarks::raw;
  const int result = raw_main(argc, argv, server, client);
  std::fflush(stdout);
  std::_Exit(result);  // Fast DDS's entities end with the process
}
