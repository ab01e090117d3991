"""What it takes to add a selection strategy of Skein's: its source, its maker, which describes it, and the factory that knows it by name."""

from additions import Edit, NewFile

MOST = 4
EDITS = (
    NewFile("src/selection/dummy_selection.cpp", text="""\
#include "skein/selection.hpp"

namespace skein {
namespace {

class DummySelection final : public SelectionStrategy {
 public:
  std::string name() const override { return "dummy"; }
  bool reads_history() const override { return false; }

  Selection select(const std::vector<Candidate>& candidates,
                   const Situation& situation) const override {
    return make_declared_selection()->select(candidates, situation);
  }
};

}  // namespace

std::shared_ptr<const SelectionStrategy> make_dummy_selection() {
  return std::make_shared<DummySelection>();
}

}  // namespace skein
"""),
    Edit("src/entity/CMakeLists.txt", before="../selection/history.cpp", text="../selection/dummy_selection.cpp "),
    Edit("include/skein/selection.hpp", before="/// The selection strategies by name;",
         text="/// Selects as `declared` does. Name: `dummy`.\nstd::shared_ptr<const SelectionStrategy> make_dummy_selection();\n\n"),
    Edit("src/selection/selection.cpp", after="  add(make_learned_selection());\n", text="  add(make_dummy_selection());\n"),
)
TARGETS = ("selection_test", "head_test", "head_parts_test", "skein_command")
TESTS = "^(selection_test|head_test|head_parts_test)$"
