#include "brokerless_discovery/observers.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "descriptions.hpp"

using namespace skein;
using namespace skein::brokerless_discovery;
using skein::test::description;

namespace {

/// Takes no task while it is full.
struct Control final : Executor {
  bool post(Action task) override { return !full && tasks.post(std::move(task)); }
  void post_or_run(Action task) override { tasks.post_or_run(std::move(task)); }

  ManualExecutor tasks;
  bool full = false;
};

struct Observed {
  /// What the table does at a change, and what follows when its lock is free again.
  void change(const std::string& service) {
    observers.note({{Change::Kind::Added,
                     std::make_shared<ServiceDescription>(description(1, service, "navigator"))}});
    observers.tell_later();
  }
  std::function<void(const Change&)> note_down(const std::string& name) {
    return [this, name](const Change& change) {
      told.push_back(name + " " + change.description->service);
    };
  }

  Control control;
  std::shared_ptr<void> owner = std::make_shared<int>();
  const std::weak_ptr<void> weak_owner = owner;
  Observers observers{control, weak_owner};
  std::vector<std::string> told;
};

using Told = std::vector<std::string>;

}  // namespace

TEST_CASE_METHOD(Observed, "each change is told to all observers before the next, by one task") {
  observers.add(note_down("first"));
  observers.add(note_down("second"));
  change("A/I");
  change("B/I");
  CHECK(told.empty());
  CHECK(control.tasks.run_all() == 1);
  CHECK(told == Told{"first A/I", "second A/I", "first B/I", "second B/I"});
}

TEST_CASE_METHOD(Observed, "an observer is not told of changes before the first observer came") {
  change("A/I");
  observers.add(note_down("first"));
  change("B/I");
  control.tasks.run_all();
  CHECK(told == Told{"first B/I"});
}

TEST_CASE_METHOD(Observed, "changes that find no room on the executor are told with the next one") {
  observers.add(note_down("first"));
  control.full = true;
  change("A/I");
  control.full = false;
  CHECK(control.tasks.run_all() == 0);
  change("B/I");
  CHECK(control.tasks.run_all() == 1);
  CHECK(told == Told{"first A/I", "first B/I"});
}

TEST_CASE_METHOD(Observed, "an observer may remove another one, which is not told any more") {
  const auto second = std::make_shared<std::shared_ptr<Observers::Observer>>();
  observers.add([this, second](const Change&) { observers.remove(*second); });
  *second = observers.add(note_down("second"));
  change("A/I");
  control.tasks.run_all();
  CHECK(told.empty());
}

TEST_CASE_METHOD(Observed, "a task that comes after the owner's end tells nothing") {
  observers.add(note_down("first"));
  change("A/I");
  owner.reset();
  CHECK(control.tasks.run_all() == 1);
  CHECK(told.empty());
}
