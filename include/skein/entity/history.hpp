#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "skein/core/clock.hpp"

namespace skein {

/// What of a request may matter for the choice, as a number: `{"cells", 65536}`.
struct Feature {
  std::string name;
  double value = 0;
  bool operator==(const Feature&) const = default;
};
using Features = std::vector<Feature>;

/// What a CSP's own history says of a request like this one.
struct Prediction {
  std::size_t samples =
      0;  ///< Its runs on the most similar requests, on which this rests; at least 1.
  /// Of the time to an answer; nothing where none of these runs brought one. A run that was given
  /// up counts with twice the time that it had had.
  std::optional<Duration> median;
  std::optional<Duration> q95;
  std::optional<double> quality;  ///< The mean of what was measured.
  double reliability = 1;  ///< The share of results that were accepted, one success more assumed.
  std::uint64_t idle = 0;  ///< Decisions since it last ran.
  bool operator==(const Prediction&) const = default;
};

/// Orders by interface and CSP, and finds by views of them.
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
/// neighbours. Similar are requests whose features differ by a small part of their size, and recent
/// ones; what is older than 256 runs is forgotten, and all that is old once five runs in a row took
/// twice or half of what was predicted. Pure and deterministic: the same samples give the same
/// predictions. Not thread-safe.
class History {
 public:
  struct Sample {
    Features features;
    Duration took{};
    bool accepted = false;
    bool late = false;              ///< Given up: an answer would have taken longer than `took`.
    std::optional<double> quality;  ///< Of an accepted result.
    std::uint64_t decision = 0;     ///< Filled by add().
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

  /// Nothing for a CSP that has never run.
  std::optional<Prediction> predict(std::string_view interface, std::string_view csp,
                                    const Features& features) const;
  /// Whether one of its runs that are remembered was late.
  bool was_late(std::string_view interface, std::string_view csp) const;
  Decisions decisions(std::string_view interface) const;

  /// As JSON, which from_json() reads back the same. from_json() throws InvalidArgument with the
  /// place for a text that is none, and for another version.
  std::string to_json() const;
  static History from_json(const std::string& text);

  /// To a file, and back; a file that does not exist is an empty history. Throw InvalidArgument
  /// with path and place. The file is replaced as a whole: who reads meanwhile reads the old one.
  void save(const std::string& path) const;
  static History load(const std::string& path);

  bool operator==(const History&) const = default;

 private:
  struct Record {
    std::deque<Sample> samples;  // oldest first
    int surprises = 0;           // in a row: positive were slower than predicted, negative faster
    mutable std::optional<std::pair<Features, Prediction>>
        predicted{};  // of the samples as they are
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
