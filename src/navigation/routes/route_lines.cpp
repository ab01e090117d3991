#include "navigation/routes/route_lines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace skein::navigation {
namespace {

constexpr double kStep = 1.5;      ///< Between samples.
constexpr double kTogether = 3.5;  ///< Lines nearer than this hide each other.
constexpr double kDash = 13;
constexpr double kShortest = 2 * kDash;  ///< What is shorter is a crossing.

struct Sample {
  PicturePoint at;
  double along = 0;                   ///< From the line's beginning.
  std::vector<std::size_t> together;  ///< Lines that run here, in ascending order, with its own.
  double turn = 0;                    ///< Along the first of those, which all of them count by.
};
using Samples = std::vector<Sample>;

Samples sampled(const std::vector<PicturePoint>& line) {
  Samples samples;
  double along = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double dx = line[i + 1].x - line[i].x;
    const double dy = line[i + 1].y - line[i].y;
    const double length = std::hypot(dx, dy);
    const int steps = std::max(1, static_cast<int>(std::ceil(length / kStep)));
    for (int k = 0; k < steps; ++k) {
      const double part = static_cast<double>(k) / steps;
      samples.push_back(
          {{line[i].x + part * dx, line[i].y + part * dy}, along + part * length, {}, 0});
    }
    along += length;
  }
  if (!line.empty()) samples.push_back({line.back(), along, {}, 0});
  return samples;
}

/// The nearest sample of the line; null where all are too far.
const Sample* nearest(const Samples& line, const PicturePoint& at) {
  const Sample* best = nullptr;
  double least = kTogether;
  for (const Sample& sample : line) {
    const double distance = std::hypot(sample.at.x - at.x, sample.at.y - at.y);
    if (distance > least) continue;
    least = distance;
    best = &sample;
  }
  return best;
}

void find_company(std::vector<Samples>& lines, std::size_t own) {
  for (Sample& sample : lines[own]) {
    for (std::size_t other = 0; other < lines.size(); ++other) {
      const Sample* const near = other == own ? &sample : nearest(lines[other], sample.at);
      if (!near) continue;
      if (sample.together.empty()) sample.turn = near->along;
      sample.together.push_back(other);
    }
  }
}

/// Lines that only cross do not take turns.
void ignore_crossings(Samples& line, std::size_t own) {
  for (std::size_t begin = 0; begin < line.size();) {
    std::size_t end = begin;
    while (end < line.size() && line[end].together.size() > 1) ++end;
    if (end > begin && line[end - 1].along - line[begin].along < kShortest) {
      for (std::size_t i = begin; i < end; ++i) line[i].together = {own};
    }
    begin = std::max(end, begin + 1);
  }
}

bool has_its_turn(const Sample& sample, std::size_t own) {
  const auto& together = sample.together;
  if (together.size() < 2) return true;
  const auto turn = static_cast<std::size_t>(sample.turn / kDash) % together.size();
  return together[turn] == own;
}

std::string path_of(const Samples& line, std::size_t own) {
  std::string path;
  bool drawing = false;
  for (const Sample& sample : line) {
    const bool draws = has_its_turn(sample, own);
    if (draws) {
      path += fmt::format("{}{:.1f} {:.1f}", drawing ? 'L' : 'M', sample.at.x, sample.at.y);
    }
    drawing = draws;
  }
  return path;
}

}  // namespace

std::vector<std::string> lines_side_by_side(std::span<const std::vector<PicturePoint>> lines) {
  std::vector<Samples> samples;
  for (const auto& line : lines) samples.push_back(sampled(line));
  for (std::size_t i = 0; i < samples.size(); ++i) find_company(samples, i);
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ignore_crossings(samples[i], i);
    paths.push_back(path_of(samples[i], i));
  }
  return paths;
}

}  // namespace skein::navigation
