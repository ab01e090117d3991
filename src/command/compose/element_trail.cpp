#include "element_trail.hpp"

#include <algorithm>

namespace skein::command::compose {
namespace {

constexpr std::size_t kMostSteps = 100;

}  // namespace

void ElementTrail::add(std::uint64_t version, const profile::XmlSource* before,
                       const profile::Splice& change) {
  Step step{version, {}, change};
  if (before)
    for (const auto& element : before->elements()) step.begins.push_back(element.begin);
  steps_.push_back(std::move(step));
  if (steps_.size() > kMostSteps) steps_.pop_front();
}

std::optional<std::size_t> ElementTrail::find(std::size_t element, std::uint64_t version,
                                              const profile::XmlSource& now) const {
  auto step = std::ranges::find(steps_, version, &Step::version);
  if (step == steps_.end() || element >= step->begins.size()) return std::nullopt;
  std::size_t begin = step->begins[element];
  for (; step != steps_.end(); ++step) {
    const profile::Splice& change = step->change;
    if (begin < change.at) continue;
    if (begin < change.at + change.removed) return std::nullopt;
    begin += change.inserted.size() - change.removed;
  }
  const auto found = std::ranges::find(now.elements(), begin, &profile::SourceElement::begin);
  if (found == now.elements().end()) return std::nullopt;
  return static_cast<std::size_t>(found - now.elements().begin());
}

}  // namespace skein::command::compose
