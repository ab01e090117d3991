#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "skein/clock.hpp"

namespace skein {

/// A property of a request that may matter for the choice, as a number: `{"cells", 65536}`.
struct Feature {
  std::string name;
  double value = 0;
  bool operator==(const Feature&) const = default;
};
using Features = std::vector<Feature>;

/// What a CSP's own history predicts for a request.
struct Prediction {
  std::size_t samples = 0;  ///< Number of most similar runs that it is based on: 1 to 12.
  /// Time to an accepted result; unset if none of these runs was accepted or late. A late run,
  /// which was given up, counts with twice its time.
  std::optional<Duration> median;
  std::optional<Duration> p95;
  std::optional<double> quality;  ///< Mean of the measured values.
  double reliability = 1;         ///< Share of accepted results, with one success added.
  std::uint64_t idle = 0;         ///< Decisions since it last ran.
  bool operator==(const Prediction&) const = default;
};

/// Orders by interface and CSP; allows look-up by views of them.
struct ByCsp {
  using is_transparent = void;
  using View = std::pair<std::string_view, std::string_view>;
  static View view(const std::pair<std::string, std::string>& key) {
    return {key.first, key.second};
  }
  static const View& view(const View& key) { return key; }
  bool operator()(const auto& left, const auto& right) const { return view(left) < view(right); }
};

/// What each CSP made of past requests: Rice's model (features to performance) by nearest
/// neighbours. A run is near if its features differ little in proportion to their size, and if it
/// is recent. The last 256 runs of each CSP are kept. After five runs in a row that all took more
/// than twice the predicted time, or all less than half, only these five are kept. Pure and
/// deterministic: the same samples give the same predictions. Not thread-safe, including the const
/// functions.
class History {
 public:
  struct Sample {
    Features features;
    Duration took{};
    bool accepted = false;
    bool late = false;              ///< Given up: an answer would have taken longer than `took`.
    std::optional<double> quality;  ///< Of an accepted result.
    std::uint64_t decision = 0;     ///< Set by add().
    bool operator==(const Sample&) const = default;
  };
  struct Decisions {
    std::uint64_t made = 0;
    std::uint64_t explored = 0;
    bool operator==(const Decisions&) const = default;
  };

  static constexpr std::size_t kKept = 256;
  static constexpr std::size_t kNeighbours = 12;

  void add(std::string_view interface, std::string_view csp, Sample sample);
  void count(std::string_view interface, bool explored);

  /// nullopt for a CSP that has never run.
  std::optional<Prediction> predict(std::string_view interface, std::string_view csp,
                                    const Features& features) const;
  Decisions decisions(std::string_view interface) const;

  /// To JSON and back without loss. from_json() throws InvalidArgument with the place for invalid
  /// text and for another version.
  std::string to_json() const;
  static History from_json(const std::string& text);

  /// To a file and back; a file that does not exist is an empty history. Both throw InvalidArgument
  /// with the path, load() also with the place. The file is replaced as a whole: a reader gets the
  /// old or the new one.
  void save(const std::string& path) const;
  static History load(const std::string& path);

  bool operator==(const History&) const = default;

 private:
  struct Record {
    std::deque<Sample> samples;  // oldest first
    int surprises = 0;           // in a row: positive if slower than predicted, negative if faster
    mutable std::optional<std::pair<Features, Prediction>> predicted{};  // for the present samples
    bool operator==(const Record& other) const {
      return samples == other.samples && surprises == other.surprises;
    }
  };
  static Prediction predict(const std::deque<Sample>& samples, const Features& features);
  static void note_surprise(Record& record, const Prediction& before, const Sample& sample);

  std::map<std::pair<std::string, std::string>, Record, ByCsp> records_;
  std::map<std::string, Decisions, std::less<>> decisions_;
};

}  // namespace skein
