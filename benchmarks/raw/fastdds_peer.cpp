// A call written with Fast DDS's own API, in the way that a careful user writes one, with the
// transport of Skein's back end: no code of the user's on Fast DDS's threads but a notification.

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <mutex>
#include <thread>

#include SKEIN_RAW_FAST_DDS

#include "raw/fastdds_participant.hpp"
#include "raw/main.hpp"
#include "raw/neighbour.hpp"

namespace skein::benchmarks::raw {
namespace {

/// Answers all requests that wait; whether there were any.
bool answer(dds::DataReader& requests, dds::DataWriter& replies) {
  bool answered = false;
  Message request;
  dds::SampleInfo info;
  while (requests.take_next_sample(&request, &info) == kOk) {
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
  FastddsParticipant participant(options.domain, way);
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
    while (replies_->take_next_sample(&reply, &info) == kOk) {
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
  FastddsParticipant participant_;
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
  const int result = raw_main(argc, argv, server, client, fastdds_neighbour);
  std::fflush(stdout);
  std::_Exit(result);  // Fast DDS's entities end with the process
}
