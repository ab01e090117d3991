#include "test/idl/samples.hpp"

#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "beyond_idlc.idl.hpp"
#include "names.idl.hpp"
#include "nested.idl.hpp"
#include "planner.idl.hpp"
#include "recording/mcap/writer.hpp"
#include "recording/viewers/recording_idl.hpp"
#include "skein/describe.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"

// Writes a recording with values of all types, each on a topic of its own, and beside it, in
// attachments, what a viewer should make of them: `types.json` and `values.json`. Says on standard
// output which types have no schema, and why.
namespace skein::test {
namespace {

class Samples {
 public:
  explicit Samples(const std::string& path) : writer_(path, options()) {}

  /// The given values, and one of initial values.
  template <class T>
  void add(const std::vector<T>& values) {
    const TypeSupport& support = idl::type_support<T>();
    const std::string name(support.name);
    const types::TypeSystem system = describe(support);
    types_ = describe(support, std::move(types_));
    std::uint16_t schema = 0;
    try {
      auto idl = recording::to_recording_idl(system, name);
      schema = writer_.add_schema(std::move(idl.type), "omgidl", std::move(idl.text));
    } catch (const InvalidArgument& error) {
      std::cout << "no schema for " << name << ": " << error.what() << '\n';
    }
    const auto channel = writer_.add_channel(name, schema);
    add_value(channel, name, T{});
    for (const T& value : values) add_value(channel, name, value);
  }

  void finish() {
    writer_.attach({"types.json", "application/json", idl::to_json(types_), 0, 0});
    writer_.attach({"values.json", "application/json", values_.dump(), 0, 0});
    writer_.add_metadata({"made", {{"by", "samples"}}});
    writer_.close();
  }

 private:
  static recording::WriterOptions options() {
    recording::WriterOptions options;
    options.chunk_size = 2000;
    options.wait_for_room = true;
    return options;
  }

  template <class T>
  void add_value(std::uint16_t channel, const std::string& name, const T& value) {
    const Bytes message = idl::encode_message(value);
    writer_.write({channel, ++sequence_, sequence_, sequence_, message});
    values_.push_back({{"type", name}, {"value", nlohmann::json::parse(idl::to_json(value))}});
  }

  recording::Writer writer_;
  types::TypeSystem types_;
  nlohmann::json values_ = nlohmann::json::array();
  std::uint32_t sequence_ = 0;
};

recursive::Link links() {
  recursive::Link last{2, {}};
  recursive::Link first{1, {}};
  first.next = last;
  return first;
}

recursive::Expression expression() {
  recursive::Expression one;
  one.value(1.5);
  recursive::Expression sum;
  sum.operands({one, one});
  recursive::Expression whole;
  whole.operands({sum, one});
  return whole;
}

nested::Fixed fixed() { return {5, -6, {"one", "three"}}; }

nested::Outer outer() {
  nested::Pick fixed_one;
  fixed_one.fixed(fixed());
  nested::Pick loose_ones;
  loose_ones.loose({{1, "text"}, {2, {}}});
  nested::Outer outer;
  outer.fixed = fixed();
  outer.more = {fixed(), {}};
  outer.loose = {7, "loose"};
  outer.looses = {{8, {}}, {9, "text"}};
  outer.pick = fixed_one;
  outer.picks = {fixed_one, {}, loose_ones};
  outer.words = {{"a", {"b", "cd"}}, {"e", {}}};
  outer.maybe = {"x", "yz"};
  outer.number = 0.125L;
  outer.wide = {L"wide", L""};
  outer.last = 18000000000000000000ULL;
  return outer;
}

nested::Top top() {
  nested::Top top;
  top.outer = outer();
  top.more = {fixed()};
  top.looses = {{1, {2, "text"}}};
  top.names = {"one", "three"};
  top.picks = outer().picks;
  top.last = 2.5;
  return top;
}

void add_all(Samples& samples) {
  samples.add<nested::Fixed>({fixed()});
  samples.add<nested::Outer>({outer()});
  samples.add<nested::Plain>({{outer(), outer(), 2.5}});
  samples.add<nested::Top>({top()});

  samples.add<everything::Basic>({samples::basic()});
  samples.add<everything::Compound>({samples::compound()});
  samples.add<everything::Choices>({samples::choices()});
  samples.add<everything::Shape>({samples::choices().shapes[1]});
  samples.add<everything::Number>({samples::choices().number});
  samples.add<everything::Maybe>({samples::choices().maybe});
  samples.add<everything::ByLetter>({samples::choices().letter});
  samples.add<everything::ShortKey>({{5, 0.5, 7}});
  samples.add<everything::TextKey>({{"key", -3}});
  samples.add<everything::PartKey>({{1, {2, 0.5}, everything::Colour::Blue}});
  samples.add<everything::PairKey>({{{1, 2, 3}, {"x", 4}}});
  samples.add<everything::WholeKey>({{{1, 2}, 3}});
  samples.add<everything::Top_Local>({{5}});
  samples.add<everything::Top_Pick>({});
  samples.add<test_planner::Problem>(
      {{{1, 2, 3}, {4, 5, 6}, test_planner::Speed::Fast, {1, 2, 3}}});
  samples.add<test_planner::Route>({{{{1, 2, 3}, {4, 5, 6}}, 0.25, "remark"}});
  samples.add<test_planner::IPlanner_Statistics>({{7, 0.5}});

  samples.add<modern::Leaf>({samples::leaf()});
  samples.add<modern::FromNothing>({{{}, 5}});
  samples.add<modern::Maps>({samples::maps()});
  samples.add<modern::WideText>({samples::wide_text()});
  samples.add<modern::Bits>({samples::bits()});
  modern::ByLetter by_letter;
  by_letter.text(samples::wide_text());
  samples.add<modern::ByLetter>({by_letter});
  modern::ByNumber by_number;
  by_number.pairs({{1, 2}, {3, 4}});
  samples.add<modern::ByNumber>({by_number});
  modern::ByLevel by_level;
  by_level.y(-5);
  samples.add<modern::ByLevel>({by_level});

  samples.add<extensible::Part>({samples::part()});
  samples.add<extensible::PartLater>({samples::part_later()});
  samples.add<extensible::Nothing>({});
  samples.add<extensible::Whole>({samples::whole()});
  samples.add<extensible::Report>({samples::report()});
  samples.add<extensible::ReportLater>({samples::report_later()});
  samples.add<extensible::ReportThatMatters>({{3, 4}});
  samples.add<extensible::Hashed>({{5, 6}});
  samples.add<extensible::Choice>({samples::choice()});
  samples.add<extensible::Leaf>({samples::extended_leaf()});
  samples.add<extensible::Quads>({{1, -0.5L, {0.25L, 1e30L}}});
  extensible::Wide wide;
  wide.values.emplace()[511] = 2.5;
  samples.add<extensible::Wide>({wide});
  samples.add<extensible::Crowd>({{{wide, {}}}});
  extensible::Either either;
  either.part({3, "piece"});
  samples.add<extensible::Either>({either});

  samples.add<recursive::Tree>({samples::tree()});
  samples.add<recursive::Expression>({expression()});
  samples.add<recursive::Link>({links()});
  samples.add<recursive::Pair>({});
  samples.add<recursive::Sum>({});

  samples.add<names::_cxx_class>({{1, "text", 2, 3, 4}});
  samples.add<names::switches>({});

  samples.add<introspection::CallEvents>(
      {{{{{}, 5, introspection::CallStep::Answered, "uav/nav", "I", "plan", "", 1}}, 2}});
  samples.add<introspection::Decision>({});
}

}  // namespace
}  // namespace skein::test

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "recording_samples FILE\n");
    return 2;
  }
  try {
    skein::test::Samples samples(arguments[1]);
    skein::test::add_all(samples);
    samples.finish();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
