// A call written with Cyclone DDS's own API, in the way that a careful user writes one, with the
// transport of Skein's back end: no code of the user's on Cyclone's threads but a notification.

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

#include "raw/cyclonedds_participant.hpp"
#include "raw/neighbour.hpp"

namespace skein::benchmarks::raw {
namespace {

void serve(CycloneddsParticipant& participant, Way way, const std::atomic<bool>& ending) {
  const auto request_topic = participant.topic(kRequestTopic);
  const auto reply_topic = participant.topic(kReplyTopic);
  const dds_entity_t requests = participant.reader(request_topic);
  const dds_entity_t replies = participant.writer(reply_topic);
  const dds_entity_t waiting = participant.waitset();
  const dds_entity_t condition = check(dds_create_readcondition(requests, DDS_ANY_STATE));
  check(dds_waitset_attach(waiting, condition, 0));
  SpinningPause pause;
  while (!ending) {
    dds_attach_t active;
    bool answered = false;
    if (way != Way::Polling) dds_waitset_wait(waiting, &active, 1, DDS_MSECS(100));
    Message request;
    while (take(requests, request)) {
      const Content result = echo(request.content);
      write(replies, reply_topic.type, {request.head, &result});
      answered = true;
    }
    if (way == Way::Polling) pause.after(answered);
  }
}

/// (To write from a listener stalls: the thread that runs it would have to hear of
/// acknowledgments.)
Way way_of(const RawOptions& options) {
  return parse_way(options.way, {{"polling", Way::Polling}});
}

void server(const RawOptions& options, const std::function<void()>& meanwhile) {
  const Way way = way_of(options);
  CycloneddsParticipant participant(options.domain);
  std::atomic<bool> ending{false};
  std::thread thread([&] { serve(participant, way, ending); });
  meanwhile();
  ending = true;
  thread.join();
}

class Client {
 public:
  explicit Client(const RawOptions& options)
      : way_(way_of(options)),
        participant_(options.domain),
        request_topic_(participant_.topic(kRequestTopic)),
        requests_(participant_.writer(request_topic_)) {
    dds_listener_t* listener = dds_create_listener(this);
    dds_lset_data_available(
        listener, [](dds_entity_t, void* self) { static_cast<Client*>(self)->data_available(); });
    replies_ = participant_.reader(participant_.topic(kReplyTopic),
                                   way_ == Way::Polling ? nullptr : listener);
    dds_delete_listener(listener);
    dds_guid_t guid;
    check(dds_get_guid(requests_, &guid));
    std::memcpy(id_.data(), guid.v, id_.size());
  }

  std::optional<Content> call(const Content& content, std::chrono::milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    write(requests_, request_topic_.type, {{id_, ++number_}, &content});
    do {
      Message reply;
      while (take(replies_, reply)) {
        if (reply.head.client == id_ && reply.head.number == number_)
          return std::move(reply.content);
      }
    } while (await_data(end));
    return std::nullopt;
  }

 private:
  bool await_data(std::chrono::steady_clock::time_point end) {
    if (way_ == Way::Polling) return std::chrono::steady_clock::now() < end;
    std::unique_lock lock(mutex_);
    const bool arrived = changed_.wait_until(lock, end, [&] { return arrived_; });
    arrived_ = false;
    return arrived;
  }

  void data_available() {
    std::lock_guard lock(mutex_);
    arrived_ = true;
    changed_.notify_one();
  }

  const Way way_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool arrived_ = false;
  ClientId id_{};
  std::uint32_t number_ = 0;
  CycloneddsParticipant participant_;
  CycloneddsParticipant::Topic request_topic_;
  dds_entity_t requests_ = 0;
  dds_entity_t replies_ = 0;
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
  return raw_main(argc, argv, server, client, cyclonedds_neighbour);
}
