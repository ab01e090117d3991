#include "core/weak_list.hpp"

#include <catch2/catch.hpp>

using skein::WeakList;

TEST_CASE("a list of weak references drops ended ones whenever it has doubled") {
  WeakList<int> list;
  const auto kept = std::make_shared<int>(0);
  list.push(kept);
  for (int i = 0; i < 1000; ++i) {
    list.push(std::make_shared<int>(i));
    REQUIRE(list.all().size() <= 17);
  }
  CHECK(list.all().front().lock() == kept);
  std::vector<std::shared_ptr<int>> many;
  for (int i = 0; i < 100; ++i) list.push(many.emplace_back(std::make_shared<int>(i)));
  CHECK(list.take_all().size() >= 101);
  CHECK(list.all().empty());
}

TEST_CASE("a list of weak references also drops what is over and still referred to") {
  WeakList<bool> list;
  std::vector<std::shared_ptr<bool>> all;
  for (int i = 0; i < 100; ++i)
    list.push(all.emplace_back(std::make_shared<bool>(true)),
              [](const std::weak_ptr<bool>& each) { return *each.lock(); });
  CHECK(list.all().size() <= 17);
}
