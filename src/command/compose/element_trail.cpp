#include "element_trail.hpp"

#include <algorithm>

namespace skein::command::compose {
namespace {

constexpr std::size_t kMostSteps = 100;

}  // namespace

void ElementTrail::add(std::uint64_t version, const profile::XmlSource* before,
                       const profile::Splice& change, Kind kind) {
  Step step{version, {}, change, kind};
  if (before)
    for (const auto& each : before->elements()) step.elements.push_back({each.begin, each.end});
  steps_.push_back(std::move(step));
  if (steps_.size() > kMostSteps) steps_.pop_front();
}

/// The place of the element that began there, after the step.
std::optional<std::size_t> ElementTrail::place_after(const Step& step, std::size_t begin) {
  const auto element = std::ranges::find(step.elements, begin, &Element::begin);
  if (element == step.elements.end()) return std::nullopt;
  const profile::Splice& change = step.change;
  const std::size_t change_end = change.at + change.removed;
  const bool outermost = element == step.elements.begin();
  if (step.kind == Kind::Other && !outermost && element->begin < change_end &&
      element->end > change.at)
    return std::nullopt;
  if (begin < change.at) return begin;
  if (begin < change_end) return std::nullopt;
  return begin + change.inserted.size() - change.removed;
}

std::optional<std::size_t> ElementTrail::find(std::size_t element, std::uint64_t version,
                                              const profile::XmlSource& now) const {
  auto step = std::ranges::find(steps_, version, &Step::version);
  if (step == steps_.end() || element >= step->elements.size()) return std::nullopt;
  std::optional<std::size_t> begin = step->elements[element].begin;
  for (; begin && step != steps_.end(); ++step) begin = place_after(*step, *begin);
  if (!begin) return std::nullopt;
  const auto found = std::ranges::find(now.elements(), *begin, &profile::SourceElement::begin);
  if (found == now.elements().end()) return std::nullopt;
  return static_cast<std::size_t>(found - now.elements().begin());
}

}  // namespace skein::command::compose
