#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <fastdds/rtps/builtin/data/TopicDescription.hpp>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

#include "dds/fastdds/fast_dds.hpp"

// Fast DDS's own, exported but in no header.
namespace eprosima::fastdds::rtps {
class RTPSDomainImpl {
 public:
  static std::shared_ptr<RTPSDomainImpl> get_instance();
};
class StatefulWriter : public RTPSWriter {
 public:
  bool send_periodic_heartbeat(bool final, bool liveliness);
};
class WLP {
 public:
  StatefulWriter* builtin_writer();
  WriterHistory* builtin_writer_history();
};
}  // namespace eprosima::fastdds::rtps
namespace eprosima::fastdds::dds::detail {
struct LogResources;
const std::shared_ptr<LogResources>& get_log_resources();
}  // namespace eprosima::fastdds::dds::detail

namespace skein::dds::fastdds {
namespace {

/// Each payload lies in a block that counts its holders. Some blocks are kept: a large one of fresh
/// memory takes longer to fill than to send. Thread-safe.
class HeldPayloads final : public rtps::IPayloadPool {
 public:
  HeldPayloads() = default;
  HeldPayloads(const HeldPayloads&) = delete;
  HeldPayloads& operator=(const HeldPayloads&) = delete;
  ~HeldPayloads() override {
    for (Block* const block : spare_) std::free(block);
  }

  bool get_payload(std::uint32_t size, rtps::SerializedPayload_t& payload) override {
    Block* const block = take(size);
    if (block == nullptr) return false;
    block->holders = 1;
    payload.data = reinterpret_cast<rtps::octet*>(block + 1);
    payload.max_size = block->size;
    payload.payload_owner = this;
    return true;
  }
  bool get_payload(const rtps::SerializedPayload_t& data,
                   rtps::SerializedPayload_t& payload) override {
    if (data.payload_owner == this) {
      ++block_of(data)->holders;
      payload.data = data.data;
      payload.max_size = data.max_size;
      payload.payload_owner = this;
    } else {
      if (!get_payload(data.length, payload)) return false;
      std::memcpy(payload.data, data.data, data.length);
    }
    payload.length = data.length;
    payload.encapsulation = data.encapsulation;
    return true;
  }
  bool release_payload(rtps::SerializedPayload_t& payload) override {
    if (Block* const block = block_of(payload); --block->holders == 0) keep(block);
    payload.data = nullptr;
    payload.length = payload.max_size = payload.pos = 0;
    payload.payload_owner = nullptr;
    return true;
  }

 private:
  struct Block {
    std::atomic<std::uint32_t> holders;
    std::uint32_t size;  // of what follows
  };

  static Block* block_of(const rtps::SerializedPayload_t& payload) {
    return reinterpret_cast<Block*>(payload.data) - 1;
  }

  Block* take(std::uint32_t size) {
    constexpr std::uint32_t kLeast = 512;
    {
      const std::lock_guard lock(mutex_);
      const auto found =
          std::ranges::find_if(spare_, [&](const Block* block) { return block->size >= size; });
      if (found != spare_.end()) {
        Block* const block = *found;
        spare_size_ -= block->size;
        spare_.erase(found);
        return block;
      }
    }
    const std::uint32_t room = std::max(size, kLeast);
    void* const memory = std::malloc(sizeof(Block) + room);
    return memory == nullptr ? nullptr : new (memory) Block{0, room};
  }

  void keep(Block* block) {
    constexpr std::size_t kMostSpares = 4;
    constexpr std::size_t kMostSpareSize = 16 << 20;
    {
      const std::lock_guard lock(mutex_);
      if (spare_.size() < kMostSpares && spare_size_ + block->size <= kMostSpareSize) {
        spare_size_ += block->size;
        spare_.push_back(block);
        return;
      }
    }
    std::free(block);
  }

  std::mutex mutex_;
  std::vector<Block*> spare_;
  std::size_t spare_size_ = 0;
};

rtps::TopicDescription description(const Topic& topic) {
  rtps::TopicDescription result;
  result.topic_name = topic.name;
  result.type_name = topic.type_name;
  return result;
}

}  // namespace

std::shared_ptr<rtps::IPayloadPool> make_held_payloads() {
  return std::make_shared<HeldPayloads>();
}

// The service that others ask for descriptions of types: no type of Skein's has one.
void leave_out_services(rtps::RTPSParticipantAttributes& attributes) {
  attributes.properties.properties().emplace_back("fastdds.type_propagation", "disabled");
}

bool make_known(rtps::RTPSParticipant& participant, rtps::RTPSWriter& writer, const Topic& topic,
                const WriterQos& qos) {
  return participant.register_writer(&writer, description(topic), qos);
}

bool make_known(rtps::RTPSParticipant& participant, rtps::RTPSReader& reader, const Topic& topic,
                const ReaderQos& qos) {
  return participant.register_reader(&reader, description(topic), qos);
}

rtps::CacheChange_t* new_change(rtps::RTPSWriter&, rtps::WriterHistory& history, std::uint32_t size,
                                rtps::ChangeKind_t kind, const rtps::InstanceHandle_t& key) {
  return history.create_change(size, kind, key);
}

void release_change(rtps::RTPSWriter&, rtps::WriterHistory& history, rtps::CacheChange_t& change) {
  history.release_change(&change);
}

void send_heartbeat(rtps::RTPSWriter& writer, bool liveliness) {
  constexpr bool kFinal = false;
  static_cast<rtps::StatefulWriter&>(writer).send_periodic_heartbeat(kFinal, liveliness);
}

std::pair<rtps::RTPSWriter*, rtps::WriterHistory*> liveliness_writer(
    rtps::RTPSParticipant& participant) {
  return {participant.wlp()->builtin_writer(), participant.wlp()->builtin_writer_history()};
}

void keep_static_objects() {
  [[gnu::used]] static const auto* const domain =
      new std::shared_ptr(rtps::RTPSDomainImpl::get_instance());
  [[gnu::used]] static const auto* const log =
      new std::shared_ptr(eprosima::fastdds::dds::detail::get_log_resources());
}

void turn_off_intraprocess_delivery() {
  eprosima::fastdds::LibrarySettings settings;
  settings.intraprocess_delivery = eprosima::fastdds::INTRAPROCESS_OFF;
  rtps::RTPSDomain::set_library_settings(settings);
}

}  // namespace skein::dds::fastdds
