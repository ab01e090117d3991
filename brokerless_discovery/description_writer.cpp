#include "description_writer.hpp"

#include <utility>

#include "core/log.hpp"
#include "description_topic.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {

void DescriptionWriter::add(ServiceDescription description) {
  const Guid provider{description.provider};
  {
    std::lock_guard lock(mutex_);
    put(std::move(description));
  }
  try {
    tell(provider);
  } catch (...) {
    withdraw(provider);  // nobody else could, without a Registration
    throw;
  }
}

void DescriptionWriter::leave(const Guid& provider) {
  {
    std::lock_guard lock(mutex_);
    const auto mine = own_.find(provider);
    if (mine == own_.end()) return;
    ServiceDescription description = mine->second.description;
    mark_leaving(description);
    put(std::move(description));
  }
  tell(provider);
}

// A peer knows its own services whether or not its writer and its reader have matched.
void DescriptionWriter::put(ServiceDescription description) {
  Own& mine = own_[{description.provider}];
  mine.message = idl::encode_message(description);
  mine.description = std::move(description);
  table_.change([&](Table& table) { return table.on_description(mine.description, Guid{}); });
}

// The service may have been withdrawn since put().
void DescriptionWriter::tell(const Guid& provider) {
  observers_.tell_later();
  std::lock_guard lock(mutex_);
  if (const auto mine = own_.find(provider); mine != own_.end()) write(mine->second);
}

void DescriptionWriter::write(const Own& mine) {
  const std::string& owner = mine.description.owner;
  auto& writer = writers_[owner];
  if (!writer) {
    writer = participant_.create_writer(description_topic(),
                                        description_qos({description_partition(owner)}, lease_));
  }
  writer->write(mine.message, {mine.description.provider});
}

void DescriptionWriter::withdraw(const Guid& provider) {
  {
    std::lock_guard lock(mutex_);
    const auto node = own_.extract(provider);
    if (!node) return;
    try {
      if (const auto& writer = writers_[node.mapped().description.owner]) writer->dispose(provider);
    } catch (const Error& error) {
      log(LogLevel::Warning, "broker", std::string("a withdrawal was not sent: ") + error.what());
    }
    table_.change([&](Table& table) { return table.on_withdrawn(provider, Guid{}); });
  }
  observers_.tell_later();
}

void DescriptionWriter::write_again(bool all, const std::set<Guid>& contradicted) {
  std::lock_guard lock(mutex_);
  for (const auto& [provider, mine] : own_) {
    if (!all && !contradicted.contains(provider)) continue;
    try {
      write(mine);
    } catch (const Error& error) {
      log(LogLevel::Warning, "broker",
          std::string("a description was not sent again: ") + error.what());
    }
  }
}

// The writers end outside the lock, and before the participant.
void DescriptionWriter::close() {
  std::map<std::string, std::unique_ptr<dds::Writer>> writers;
  std::lock_guard lock(mutex_);
  own_.clear();
  writers.swap(writers_);
}

}  // namespace skein::brokerless_discovery
