#include "skein/component_registry.hpp"

#include <catch2/catch.hpp>

#include "skein/error.hpp"
#include "skein/selection.hpp"

using namespace skein;

namespace {

class First final : public SelectionStrategy {
 public:
  explicit First(std::string name) : name_(std::move(name)) {}
  std::string name() const override { return name_; }
  Selection select(const std::vector<Candidate>&, const Situation& situation) const override {
    return {0, situation.remaining, "it is the first"};
  }

 private:
  const std::string name_;
};

}  // namespace

TEST_CASE("strategies that are registered stand in the order in which they came") {
  ComponentRegistry registry;
  CHECK(registry.strategies().empty());
  registry.add_strategy(std::make_shared<First>("steady"));
  registry.add_strategy(std::make_shared<First>("bold"));
  REQUIRE(registry.strategies().size() == 2);
  CHECK(registry.strategies()[0]->name() == "steady");
  CHECK(registry.strategies()[1]->name() == "bold");
  CHECK(registry.names().empty());
}

TEST_CASE("a second strategy of one name is refused, and so is one with a name of Skein's own") {
  ComponentRegistry registry;
  registry.add_strategy(std::make_shared<First>("steady"));
  CHECK_THROWS_AS(registry.add_strategy(std::make_shared<First>("steady")), InvalidArgument);
  CHECK_THROWS_WITH(registry.add_strategy(std::make_shared<First>("steady")),
                    Catch::Contains("'steady'") && Catch::Contains("load only one"));
  CHECK_THROWS_WITH(registry.add_strategy(std::make_shared<First>("learned")),
                    Catch::Contains("'learned' is one of Skein's own"));
  CHECK(registry.strategies().size() == 1);
}
