#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dds/port/port.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "skein/clock.hpp"
#include "skein/guid.hpp"
#include "skein/inspection.idl.hpp"

namespace skein::introspection {

/// Asks other entities what an Answerer answers. Thread-safe, but for its end.
class Asker {
 public:
  using Answers = std::map<Guid, inspection::Answer>;

  /// A question, which is forgotten with this object.
  class Asking {
   public:
    Asking(Asker& asker, inspection::Question question);
    ~Asking();
    Asking(const Asking&) = delete;
    Asking& operator=(const Asking&) = delete;

    /// Under the lock.
    Answers& answers() const noexcept { return *answers_; }

    /// To all that it is meant for, or again to those that have not answered.
    void send();

   private:
    void write(const inspection::Question& question) const;
    std::vector<Guid> missing() const;

    Asker& asker_;
    inspection::Question question_;
    Answers* answers_;
    bool first_ = true;
  };

  /// `participant` and `clock` live until the end of this. `gives_up` is asked by each thread that
  /// waits, each time before it asks again. Throws what Participant::create_writer() throws.
  Asker(dds::Participant& participant, Clock& clock, std::function<bool()> gives_up);

  /// What is lost, or asked before both sides have matched, is to be asked again.
  static constexpr std::chrono::milliseconds kRepetition{100};

  Clock& clock() const noexcept { return clock_; }
  std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }
  /// Participants that can be asked. Under the lock.
  const std::set<Guid>& known() const noexcept { return known_; }

  /// Waits until `complete()`, under the lock. In between it calls `ask`, without the lock.
  void await(Duration timeout, const std::function<void()>& ask,
             const std::function<bool()>& complete);

  /// The answers that have come once `complete` says so, or after `timeout`.
  Answers ask(inspection::Question question, Duration timeout,
              const std::function<bool(const Answers& answers)>& complete);

  /// The types of an interface or a topic's type; nil asks everybody. Nothing where nobody tells
  /// them within `timeout`.
  std::optional<types::TypeSystem> types(const std::string& name, const Guid& participant,
                                         Duration timeout);

 private:
  struct Asked {
    Guid participant;  // whose answer is wanted; nil: everybody's
    Answers answers{};
  };

  void on_matched(const Guid& reader, bool matched);
  void receive(const dds::Sample& sample);

  dds::Participant& participant_;
  Clock& clock_;
  const std::function<bool()> gives_up_;
  const Guid name_ = Guid::random();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<Guid> known_;
  std::map<std::uint32_t, Asked> waiting_;
  std::uint32_t last_ = 0;
  // These go first: their listeners use the rest.
  std::unique_ptr<AnyReader> reader_;
  std::unique_ptr<dds::Writer> writer_;
};

}  // namespace skein::introspection
