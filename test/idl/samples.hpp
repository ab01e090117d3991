#pragma once

#include "everything.idl.hpp"
#include "extensible.idl.hpp"
#include "external.idl.hpp"
#include "modern.idl.hpp"
#include "recursive.idl.hpp"

/// Values with something in every member.
namespace samples {

inline everything::Basic basic() {
  return {true,
          'x',
          200,
          -300,
          60000,
          -70000,
          4000000000U,
          -5000000000LL,
          18000000000000000000ULL,
          1.5F,
          -2.25,
          "text",
          everything::Colour::Blue};
}

inline everything::Compound compound() {
  everything::Compound value;
  value.matrix = {{{1, 2, 3}, {4, 5, 6}}};
  value.flags = {true, false, true};
  value.tags = {"a", "bcd", ""};
  value.table = {{1, 2}, {3}};
  value.word = "five5";
  value.words = {"one", "two"};
  value.name = "eight888";
  value.path = {{1, 2, 3}, {4, 5, 6}};
  value.paint = everything::Colour::Green;
  value.basics = {basic(), {}};
  value.mask = {true, false, true};
  value.colours = {everything::Colour::Blue, everything::Colour::Red};
  value.nested = {9};
  return value;
}

inline everything::Choices choices() {
  everything::Choices value;
  everything::Shape shape;
  value.shapes.push_back(shape);
  shape.corner({1, 2, 3});
  value.shapes.push_back(shape);
  shape.remark("round");
  value.shapes.push_back(shape);
  value.number.basic(basic());
  value.maybe.value("here");
  value.letter.text("new line");
  return value;
}

inline recursive::Tree tree() { return {"root", {{"left", {}}, {"right", {{"leaf", {}}}}}}; }

/// So many nodes one inside the other.
inline recursive::Tree chain(unsigned levels) {
  recursive::Tree tree{"end", {}};
  for (unsigned i = 1; i < levels; ++i) {
    recursive::Tree outer{"in", {}};
    outer.children.push_back(std::move(tree));
    tree = std::move(outer);
  }
  return tree;
}

inline modern::Leaf leaf() {
  modern::Leaf value;
  value.id = -8;
  value.name = "north";
  value.level = modern::Level::BELOW;
  value.phases[1][0] = modern::Phase::LAND;
  value.levels = {modern::Level::MIDDLE, modern::Level::UNSET};
  value.small = 200;
  value.large = 18000000000000000000ULL;
  return value;
}

inline modern::Maps maps() {
  modern::Maps value;
  value.ages = {{"ann", 5}, {"bob", -6}};
  value.deep = {{-1, {{"a", {1, -2}}, {"", {}}}}, {7, {}}};
  value.leaves = {{modern::Phase::CRUISE, leaf()}, {modern::Phase::CLIMB, {}}};
  return value;
}

inline modern::WideText wide_text() { return {L'\u20ac', L"\u20ac\U0001d11e", L"four", 0.5}; }

inline modern::Bits bits() {
  modern::Bits value;
  value.before = 1;
  value.flags = modern::Flags::lit | modern::Flags::ready;
  value.wide = modern::Wide::high;
  value.packet.kind = 5;
  value.packet.valid = true;
  value.packet.angle = -300;
  value.packet.number = 0xABCDE;
  value.many = {modern::Flags::armed, {}};
  return value;
}

inline extensible::Part part() { return {3, -0.5, "part"}; }

inline extensible::PartLater part_later() { return {4, 2.5, "later", 9, {{1, 2}, {3, 4}}}; }

inline extensible::Whole whole() {
  extensible::Whole value;
  value.before = 1;
  value.maybe = 1.5;
  value.text = "text";
  value.part = part();
  value.parts = {part(), {}};
  value.pair[1] = part();
  value.phases = {extensible::Phase::CRUISE, {}};
  value.matrix[1][0] = extensible::Phase::CRUISE;
  value.flags = {extensible::Flags::b, extensible::Flags::a};
  value.levels = {extensible::Level::HIGH};
  value.numbers = {1, 2, 3};
  value.path = {{1, 2}, {3, 4}};
  value.mixed = {{{1, 2.5}, {3, 4.5}}};
  value.words = {"a", "bcd"};
  value.table = {{1}, {2, 3}};
  value.wide = L"wide";
  value.names = {{1, "one"}, {2, "two"}};
  value.last = 18000000000000000000ULL;
  return value;
}

inline extensible::Report report() {
  extensible::Report value;
  value.number = 5;
  value.value = 0.25;
  value.text = "text";
  value.samples = {1, -2, 3};
  value.part = part();
  value.valid = true;
  value.phase = extensible::Phase::CRUISE;
  return value;
}

inline extensible::ReportLater report_later() {
  extensible::ReportLater value;
  value.added = -4;
  value.samples = {6, 7};
  value.number = 8;
  value.value = 0.125;
  value.where = {1, 2};
  return value;
}

inline extensible::Choice choice() {
  extensible::Choice value;
  value.part(part());
  return value;
}

inline extensible::Leaf extended_leaf() {
  extensible::Leaf value;
  value.base = 1;
  value.zone = 2;
  value.at = 3.5;
  value.own = 4;
  return value;
}

}  // namespace samples
