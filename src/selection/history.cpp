#include "skein/detail/history.hpp"

#include "service_history.hpp"

namespace skein {

using entity::ServiceHistory;

bool History::Sample::operator==(const Sample& other) const {
  return *features == *other.features && took == other.took && accepted == other.accepted &&
         late == other.late && quality == other.quality && request == other.request &&
         after == other.after;
}

History::History() = default;
History::History(History&&) noexcept = default;
History::~History() = default;

History::History(const History& other) {
  for (const auto& [interface, service] : other.services_)
    services_[interface] = std::make_unique<ServiceHistory>(*service);
}

History& History::operator=(History other) noexcept {
  services_.swap(other.services_);
  return *this;
}

bool History::operator==(const History& other) const {
  return std::equal(services_.begin(), services_.end(), other.services_.begin(),
                    other.services_.end(), [](const auto& one, const auto& another) {
                      return one.first == another.first && *one.second == *another.second;
                    });
}

ServiceHistory& History::service(std::string_view interface) {
  auto found = services_.find(interface);
  if (found == services_.end()) {
    found = services_.try_emplace(std::string(interface), std::make_unique<ServiceHistory>()).first;
  }
  return *found->second;
}

const ServiceHistory* History::find(std::string_view interface) const {
  const auto found = services_.find(interface);
  return found == services_.end() ? nullptr : found->second.get();
}

std::uint64_t History::begin(std::string_view interface) {
  return ++service(interface).decisions.made;
}

void History::note_exploration(std::string_view interface) {
  ++service(interface).decisions.explored;
}

PastDecisions History::decisions(std::string_view interface) const {
  const ServiceHistory* const found = find(interface);
  return found ? found->decisions : PastDecisions();
}

void History::add(std::string_view interface, std::string_view csp, Sample sample,
                  const Prediction* predicted) {
  service(interface).add(csp, std::move(sample), predicted);
}

std::vector<std::optional<Prediction>> History::predict(std::string_view interface,
                                                        const std::vector<std::string_view>& csps,
                                                        const Features& features) const {
  const ServiceHistory* const found = find(interface);
  if (!found) return std::vector<std::optional<Prediction>>(csps.size());
  return found->predict(csps, features);
}

std::shared_ptr<History::Lesson> History::next_lesson(std::string_view interface) const {
  const ServiceHistory* const found = find(interface);
  if (!found || !found->is_due()) return nullptr;
  return std::make_shared<Lesson>(std::string(interface), *found);
}

void History::take(Lesson& lesson) {
  service(lesson.interface_).take(lesson.learned_, lesson.version_);
}

void History::learn() {
  for (const auto& [interface, service] : services_) {
    Lesson lesson(interface, *service);
    lesson.learn();
    take(lesson);
  }
}

}  // namespace skein
