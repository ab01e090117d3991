#pragma once

#include "everything.idl.hpp"
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

}  // namespace samples
