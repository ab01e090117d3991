#pragma once

#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "dds/port/port.hpp"
#include "skein/error.hpp"

namespace skein::dds {

/// A participant's topics in use, each with what the back end keeps for it. Thread-safe.
template <class Handle>
class TopicTable {
 public:
  /// Counts one more user of the topic; the first one's `make()` provides its handle. Throws
  /// InvalidArgument where the name is in use with another type or keyedness.
  template <class Make>
  Handle acquire(const Topic& topic, Make&& make) {
    std::lock_guard lock(mutex_);
    const auto found = entries_.find(topic.name);
    if (found == entries_.end()) {
      Handle handle = make();
      entries_.emplace(topic.name, Entry{topic, handle, 1});
      return handle;
    }
    if (found->second.topic != topic) throw InvalidArgument(conflict(found->second.topic, topic));
    ++found->second.users;
    return found->second.handle;
  }

  /// Counts one user less; the last one's `destroy(handle)` ends the topic.
  template <class Destroy>
  void release(const std::string& name, Destroy&& destroy) {
    std::lock_guard lock(mutex_);
    const auto found = entries_.find(name);
    if (--found->second.users > 0) return;
    destroy(found->second.handle);
    entries_.erase(found);
  }

  /// Ends the program where a topic is in use: a participant must outlive its writers and readers.
  void expect_unused(const std::string& participant) {
    std::lock_guard lock(mutex_);
    if (entries_.empty()) return;
    std::fprintf(stderr,
                 "skein: participant '%s' is destroyed before %zu of its writers and readers on "
                 "topic '%s'; destroy these first\n",
                 participant.c_str(), entries_.begin()->second.users,
                 entries_.begin()->first.c_str());
    std::abort();
  }

 private:
  struct Entry {
    Topic topic;
    Handle handle;
    std::size_t users;
  };

  static std::string describe(const Topic& topic) {
    return "type '" + topic.type_name + (topic.keyed ? "' with keys" : "' without keys");
  }
  static std::string conflict(const Topic& old, const Topic& wanted) {
    return "topic '" + wanted.name + "' is in use in this participant with " + describe(old) +
           "; it cannot also have " + describe(wanted);
  }

  std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

/// One use of a topic of a participant that has a TopicTable, for as long as it lives.
template <class Participant>
class TopicUse {
 public:
  TopicUse(Participant& participant, const Topic& topic)
      : participant_(participant), name_(topic.name), handle_(participant.acquire_topic(topic)) {}
  ~TopicUse() { participant_.release_topic(name_); }
  TopicUse(const TopicUse&) = delete;
  TopicUse& operator=(const TopicUse&) = delete;

  const auto& handle() const noexcept { return handle_; }

 private:
  Participant& participant_;
  const std::string name_;
  const decltype(std::declval<Participant&>().acquire_topic(std::declval<const Topic&>())) handle_;
};

}  // namespace skein::dds
