"""Each check finds what it is there to find: on trees made for that, which break one rule."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import additions
import budget_rules
import class_functions
import compile_rules
import definition_rules
import include_rules
import text_rules
from source_tree import SourceTree

COMPILER = sys.argv.pop() if len(sys.argv) > 1 else "c++"


class TreeTest(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)
        self.tree = SourceTree(self.root)

    def write(self, path, text):
        whole = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(whole), exist_ok=True)
        with open(whole, "w", encoding="utf-8") as stream:
            stream.write(text)
        return whole

    def assertFinds(self, violations, *parts):
        found = list(violations)
        self.assertEqual(len(found), 1, found)
        for part in parts:
            self.assertIn(part, found[0])

    def assertFindsNothing(self, violations):
        self.assertEqual(list(violations), [])


class UnityNames(TreeTest):
    def unity(self, *texts):
        sources = [self.write(f"{number}.cpp", text) for number, text in enumerate(texts)]
        self.write("build/CMakeFiles/a.dir/Unity/unity_0_cxx.cxx", "".join(f'#include "{source}"\n' for source in sources))
        return definition_rules.unity_names(self.root)

    def test_a_function_that_stands_in_two_sources_of_a_target_is_found(self):
        self.assertFinds(self.unity("namespace a {\nnamespace {\n\nvoid check(const char* x) {\n}\n\n}  // namespace\n",
                                    "namespace a {\nnamespace {\n\nvoid check(const std::string& x) {\n"),
                         "check()", "0.cpp and 1.cpp")

    def test_others_and_those_of_other_namespaces_are_not(self):
        text = "namespace {\n\nint f(int x) {\n  return check(x);\n}\n\n}  // namespace\n"
        self.assertFindsNothing(self.unity("namespace a {\n" + text + "void g() {\n", "namespace b {\n" + text + "void g() {\n"))


class Homes(TreeTest):
    def test_a_vendor_header_outside_its_folder_is_found(self):
        self.write("src/rpc/wire.cpp", "#include <vector>\n#include <dds/dds.h>\n")
        self.assertFinds(include_rules.homes(self.tree), "src/rpc/wire.cpp:2", "Cyclone DDS")

    def test_each_library_is_known_by_its_headers(self):
        for header in ("fastdds/dds/core/policy/QosPolicies.hpp", "fastrtps/rtps/rtps_fwd.h", "fastcdr/Cdr.h",
                       "dds/ddsi/ddsi_serdata.h", "ompl/base/Planner.h", "Eigen/Core", "pugixml.hpp", "nlohmann/json.hpp",
                       "CLI/CLI.hpp"):
            self.write("src/core/x.cpp", f"#include <{header}>\n")
            self.assertFinds(include_rules.homes(self.tree), header)

    def test_one_vendor_in_the_folder_of_the_other_is_found(self):
        self.write("src/dds/fastdds/x.cpp", "#include <dds/dds.h>\n")
        self.assertFinds(include_rules.homes(self.tree), "stay in src/dds/cyclonedds")

    def test_at_home_and_in_peers_without_skein_they_are_welcome(self):
        self.write("src/dds/cyclonedds/x.cpp", "#include <dds/dds.h>\n")
        self.write("test/foreign/fastdds/x.cpp", "#include <fastdds/dds/domain/DomainParticipant.hpp>\n")
        self.write("src/navigation/planners/x.cpp", "#include <ompl/base/Planner.h>\n")
        self.write("src/fusion/x.cpp", "#include <Eigen/Core>\n")
        self.assertFindsNothing(include_rules.homes(self.tree))


class PrecompiledHeaders(TreeTest):
    def violations(self):
        return include_rules.precompiled_headers(self.tree)

    def test_those_of_others_are_taken(self):
        self.write("src/core/standard_library.hpp", "#include <vector>\n")
        self.write("test/tools/precompiled.hpp", '#include <catch2/catch.hpp>\n#include "core/standard_library.hpp"\n')
        self.write("src/a/CMakeLists.txt", "target_precompile_headers(a PRIVATE <fmt/core.h> <core/standard_library.hpp>)\n")
        self.assertFindsNothing(self.violations())

    def test_ours_are_found(self):
        self.write("src/core/x.hpp", "")
        for header in ("skein/entity.hpp", "navigator.idl.hpp", "core/x.hpp"):
            self.write("src/a/CMakeLists.txt", f"target_precompile_headers(a PRIVATE <fmt/core.h>\n  <{header}>)\n")
            self.assertFinds(self.violations(), "src/a/CMakeLists.txt", header)

    def test_ours_within_a_precompiled_header_are_found(self):
        self.write("test/tools/precompiled.hpp", '#include <catch2/catch.hpp>\n#include "skein/skein.hpp"\n')
        self.assertFinds(self.violations(), "test/tools/precompiled.hpp:2", "skein/skein.hpp")

    def test_one_that_a_source_includes_is_found(self):
        self.write("src/a/x.cpp", '#include "core/standard_library.hpp"\n')
        self.assertFinds(self.violations(), "src/a/x.cpp:1", "include what is used")


class PublicHeaders(TreeTest):
    def setUp(self):
        super().setUp()
        for folder, headers in (("", include_rules.USERS_HEADERS), ("detail/", include_rules.DETAIL_HEADERS)):
            for name in " ".join(headers.values()).split():
                self.write(f"include/skein/{folder}{name}.hpp", "")
        for name in include_rules.C_HEADERS:
            self.write(f"include/skein/c/{name}.h", "")
        self.names = " ".join(include_rules.USERS_HEADERS.values()).split()
        self.write_umbrella(self.names)

    def write_umbrella(self, names):
        self.write("include/skein/skein.hpp", "".join(f'#include "skein/{name}.hpp"\n' for name in names))

    def test_those_that_are_named_are_taken(self):
        self.assertFindsNothing(include_rules.public_headers(self.tree))

    def test_one_that_is_not_named_is_found(self):
        self.write("include/skein/detail/queue.hpp", "")
        self.assertFinds(include_rules.public_headers(self.tree), "include/skein/detail/queue.hpp", "beside their sources")

    def test_one_that_is_gone_is_found(self):
        os.remove(os.path.join(self.root, "include/skein/call.hpp"))
        self.assertFinds(include_rules.public_headers(self.tree), "include/skein/call.hpp", "does not exist")

    def test_one_that_the_umbrella_lacks_is_found(self):
        self.write_umbrella([name for name in self.names if name != "call"])
        self.assertFinds(include_rules.public_headers(self.tree), "skein.hpp: does not include skein/call.hpp")

    def test_those_that_need_another_library_may_lack(self):
        self.write_umbrella([name for name in self.names if name not in ("asio", "fusion", "skein")])
        self.assertFindsNothing(include_rules.public_headers(self.tree))


class Budget(TreeTest):
    CEILINGS = {"words of documents": 3, "users' headers": 1, "sources in the fullest folder": 1, "names that sources of two folders share": 0,
                "pronouns in 1,000 words of comments": 500, "functions beyond 15 of classes with a mutex": 1}

    def setUp(self):
        super().setUp()
        self.write(budget_rules.BUDGET, json.dumps(self.CEILINGS))
        self.write("README.md", "three words here\n")
        self.write("include/skein/call.hpp", "")
        self.write("src/a/a.hpp", "// who calls\n")
        self.write("src/a/a.cpp", "")

    def test_what_is_within_it_is_not_found(self):
        self.assertFindsNothing(budget_rules.budget(self.tree))

    def test_each_figure_above_its_ceiling_is_found(self):
        for path, text, figure in (("GUIDE.md", "more", "words of documents: 4"), ("include/skein/stream.hpp", "", "users' headers: 2"),
                                   ("src/a/b.cpp", "", "fullest folder: 2"), ("src/b/a.hpp", "", "share: 1"), ("src/b/b.cpp", "// what where", "comments: 750.0"),
                                   ("brokerless_discovery/c.hpp", self.crowd(17), "mutex: 2")):
            whole = self.write(path, text)
            self.assertFinds(budget_rules.budget(self.tree), figure)
            os.remove(whole)


    @staticmethod
    def crowd(functions):
        return "class Crowd {\n" + "".join(f"  void f{i}();\n" for i in range(functions)) + "  std::mutex mutex_;\n};\n"


class ClassFunctions(unittest.TestCase):
    def test_functions_are_counted_and_nothing_else_that_has_parentheses(self):
        self.assertEqual(list(class_functions.classes('''
            // int comment();
            template <class T>
            class Channel::State final : public Base<int(char)> {
             public:
              using Action = std::function<void()>;
              explicit State(int size) : size_(size) { other(); }
              ~State();
              State& operator=(const State&) = delete;
              static_assert(sizeof(T) == 4);
              enum class Phase { Open, Closed };
              int size() const { if (size_ > 0) { return size_; } return 0; }
              template <class Send>
              auto in_time(std::pair<int, int> limit, Send send) const;
              std::vector<std::function<void(int)>> all() const;

             private:
              struct Entry {
                bool is_due() const;
                Action action;
              };
              std::function<void(const Guid& peer)> on_peer_;
              const char* text_ = "int text();";
              std::atomic<int> size_{0};
              mutable std::mutex mutex_;
            };
            struct Plain { void run(); };
        ''')), [("Channel::State", 3, True), ("Entry", 1, False), ("Plain", 1, False)])


class Additions(TreeTest):
    TREE = {
        "CMakePresets.json": '{"version": 6, "configurePresets": [{"name": "default", "generator": "Ninja", "binaryDir": "build"}]}',
        "CMakeLists.txt": "cmake_minimum_required(VERSION 3.25)\nproject(x NONE)\nenable_testing()\n"
                          "add_custom_target(a COMMAND test -e ${PROJECT_SOURCE_DIR}/a)\n"
                          "add_test(NAME says_b COMMAND grep -q b ${PROJECT_SOURCE_DIR}/list)\n",
        "list": "one two two\n",
    }
    LINE, FILE = additions.Edit("list", after="one", text="b"), additions.NewFile("a", text="")

    def setUp(self):
        super().setUp()
        for path, text in self.TREE.items():
            self.write(path, text)

    def counted(self, most, *edits):
        return additions.count(self.root, {"x": {"MOST": most, "EDITS": edits}})

    def test_edits_are_made_where_they_say(self):
        line = additions.Edit("list", before="one", text="zero ")
        self.assertEqual(additions.edited(self.root, (self.LINE, self.FILE, line)), {"list": "zero oneb two two\n", "a": ""})

    def test_as_many_places_as_allowed_are_not_found(self):
        self.assertFindsNothing(self.counted(2, self.LINE, self.FILE))

    def test_more_places_are_found(self):
        self.assertFinds(self.counted(1, self.LINE, self.FILE), "x: 2 places", "1 are allowed")

    def test_edits_that_do_not_fit_are_found(self):
        for edit, problem in ((additions.Edit("list", after="two", text=""), "list: has 2 times: 'two'"),
                              (additions.Edit("list", after="three", text=""), "list: has 0 times"),
                              (additions.Edit("none", after="one", text=""), "none: has 0 times"),
                              (additions.NewFile("list", text=""), "list: exists already")):
            self.assertFinds(self.counted(1, edit), problem)

    def test_only_what_builds_and_passes_with_its_edits_is_an_addition(self):
        build = os.path.join(self.root, "build")
        for passes, edits in ((True, (self.LINE, self.FILE)), (False, (self.LINE,)), (False, (self.FILE,))):
            kind = {"EDITS": edits, "TARGETS": ("a",), "TESTS": "says_b"}
            self.assertEqual(additions.attempt(self.root, self.TREE, build, "x", kind) == 0, passes, edits)
            self.assertEqual(os.listdir(build), [])


class MissionLines(TreeTest):
    def setUp(self):
        super().setUp()
        self.write("CMakePresets.json", '{"version": 6, "configurePresets": [{"name": "mission", "generator": "Ninja"}]}')
        self.write("CMakeLists.txt", "cmake_minimum_required(VERSION 3.25)\nproject(x LANGUAGES CXX)\n"
                                     "add_library(x OBJECT x.cpp)\nadd_library(y OBJECT x.cpp)\n"
                                     "add_custom_target(skein_generated)\nadd_custom_target(skein_flight DEPENDS x)\n")
        self.write("x.cpp", "".join(f"int x{number};\n" for number in range(3000)))

    def violations(self, ceiling):
        self.write(budget_rules.BUDGET, json.dumps({budget_rules.MISSION_LINES: ceiling}))
        return budget_rules.mission_lines(self.tree, os.path.join(self.root, "build"))

    def test_more_lines_than_the_ceiling_are_found(self):
        self.assertFinds(self.violations(2), "mission: 3,", "allows 2")

    def test_as_many_are_not(self):
        self.assertFindsNothing(self.violations(3))


class TestFloors(TreeTest):
    AREAS = "set(areas core:0 rpc:3)\nif(x)\n  list(APPEND areas mission/profile:7)\nendif()\n"

    def test_tests_that_use_a_higher_floor_than_their_folder_has_are_found(self):
        self.write("test/CMakeLists.txt", self.AREAS)
        self.write("test/rpc/x_test.cpp", '#include "skein/entity.hpp"\n')
        self.assertFinds(include_rules.test_floors(self.tree), "test/rpc/x_test.cpp:1", "entity", "floor 3")

    def test_a_list_of_folders_that_is_not_found_is_told(self):
        self.write("test/CMakeLists.txt", "add_subdirectory(core)\n")
        self.assertFinds(include_rules.test_floors(self.tree), "names no folder with its floor")

    def test_tests_on_their_floor_are_fine(self):
        self.write("test/CMakeLists.txt", self.AREAS)
        self.write("src/mission/check/profile_check.hpp", "")
        self.write("test/mission/profile/x.cpp", '#include "mission/check/profile_check.hpp"\n#include "skein/entity.hpp"\n')
        self.assertFindsNothing(include_rules.test_floors(self.tree))


class Floors(TreeTest):
    def test_an_include_up_a_floor_is_found(self):
        self.write("src/rpc/wire/wire.hpp", "")
        self.write("src/core/call.cpp", '#include "rpc/wire/wire.hpp"\n')
        self.assertFinds(include_rules.floors(self.tree), "src/core/call.cpp:1", "core (floor 0)", "rpc/wire (floor 3)")

    def test_an_include_up_a_floor_by_a_relative_path_is_found(self):
        self.write("src/entity/head.hpp", "")
        self.write("src/connector/connector.cpp", '#include "../entity/head.hpp"\n')
        self.assertFinds(include_rules.floors(self.tree), "connector (floor 5)", "entity (floor 6)")

    def test_an_include_up_a_floor_by_a_public_header_is_found(self):
        self.write("src/rpc/wire/x.cpp", '#include "skein/detail/history.hpp"\n')
        self.assertFinds(include_rules.floors(self.tree), "rpc/wire (floor 3)", "selection (floor 3.5)")

    def test_a_generated_header_has_the_floor_of_its_idl(self):
        self.write("src/rpc/wire/x.cpp", '#include "skein/discovery.idl.hpp"\n')
        self.assertFinds(include_rules.floors(self.tree), "brokerless_discovery (floor 4)")

    def test_a_public_header_that_needs_an_internal_one_is_found(self):
        self.write("src/core/log.hpp", "")
        self.write("include/skein/call.hpp", '#include "core/log.hpp"\n')
        self.assertFinds(include_rules.floors(self.tree), "include/skein/call.hpp:1", "core/log.hpp", "not installed")

    def test_one_vendor_that_knows_the_other_is_found(self):
        self.write("src/dds/cyclonedds/writer.hpp", "")
        self.write("src/dds/fastdds/x.cpp", '#include "../cyclonedds/writer.hpp"\n')
        self.assertFinds(include_rules.floors(self.tree), "dds/cyclonedds")

    def test_neighbours_that_know_each_other_are_found(self):
        self.write("src/mission/xml/words.hpp", "")
        self.write("src/fusion/x.cpp", '#include "mission/xml/words.hpp"\n')
        self.assertFinds(include_rules.floors(self.tree), "fusion (floor 7)")

    def test_a_folder_without_a_floor_is_found(self):
        self.write("src/attic/x.cpp", "")
        self.assertFinds(include_rules.floors(self.tree), "stands on no floor")

    def test_downwards_is_allowed(self):
        self.write("src/dds/port/port.hpp", "")
        self.write("src/mission/profile/variables.hpp", "")
        self.write("brokerless_discovery/x.cpp", '#include "dds/port/port.hpp"\n#include "skein/discovery.idl.hpp"\n')
        self.write("src/mission/peer/x.cpp", '#include "mission/profile/variables.hpp"\n#include "launch.hpp"\n#include <vector>\n')
        self.assertFindsNothing(include_rules.floors(self.tree))


class Texts(TreeTest):
    def test_a_path_of_one_machine_is_found(self):
        self.write("src/core/x.cpp", '\nconst char* place = "/home/anna/skein";\n')
        self.assertFinds(text_rules.machine_paths(self.tree), "src/core/x.cpp:2", "/home/a")

    def test_paths_of_every_machine_are_allowed(self):
        self.write("dev", "cd /usr/include && ls /tmp/x src/home/x ../work/y https://host/home/x\n")
        self.assertFindsNothing(text_rules.machine_paths(self.tree))

    def test_a_test_that_sleeps_is_found(self):
        for path in text_rules.SLEEPERS:
            self.write(path, "std::this_thread::sleep_for(2ms);\n")
        self.assertFindsNothing(text_rules.sleeps(self.tree))
        for name, code in (("x.cpp", "std::this_thread::sleep_until(end);"), ("y.c", "usleep(3);"), ("z.py", "time.sleep(1)"),
                           ("w.sh", "true\n  sleep 1")):
            path = self.write("test/rpc/" + name, code + "\n")
            self.assertFinds(text_rules.sleeps(self.tree), "test/rpc/" + name)
            os.remove(path)

    def test_an_exception_that_is_none_any_more_is_found(self):
        for path in text_rules.SLEEPERS:
            self.write(path, "std::this_thread::sleep_for(2ms);\n")
        self.write("test/connector/echo_service.cpp", "")
        self.assertFinds(text_rules.sleeps(self.tree), "take it off")

    def test_code_in_readme_that_no_example_holds_is_found(self):
        self.write("examples/01/x.idl", "module m {\n  interface I {};\n};\n")
        self.write("README.md", "Text\n```idl\nmodule m {\n  interface I { void f(); };\n};\n```\n")
        self.assertFinds(text_rules.quotes(self.tree), "idl code that begins with 'module m {'")

    def test_code_in_readme_that_an_example_holds_is_taken(self):
        self.write("examples/01/x.cpp", "#include <a>\n\nint main() {\n  f();\n}\n")
        self.write("examples/01/x.py", "import a\n\na.f()\n")
        self.write("README.md", "```cpp\nint main() {\n  f();\n}\n```\n\n```python\na.f()\n```\n\n```sh\n./dev test\n```\n")
        self.assertFindsNothing(text_rules.quotes(self.tree))

    def test_code_in_readme_that_only_the_guides_files_hold_is_found(self):
        self.write("test/guide/x.cpp", "int main() {}\n")
        self.write("README.md", "```cpp\nint main() {}\n```\n")
        self.assertFinds(text_rules.quotes(self.tree), "README.md", "in no file of examples/")

    def test_code_in_the_guide_that_nobody_holds_is_found(self):
        self.write("test/guide/x.cpp", "int main() {\n  g();\n}\n")
        self.write("test/guide/x.xml", '<peer name="a"/>\n')
        for language, code in (("cpp", "int main() {\n  f();\n}"), ("idl", "module m {};"), ("xml", '<peer name="b"/>'),
                               ("cpp", "")):
            self.write("GUIDE.md", f"```{language}\n{code}\n```\n")
            self.assertFinds(text_rules.quotes(self.tree), "GUIDE.md", language, "examples/ or test/guide/")

    def test_code_in_the_guide_may_stand_deeper_in_its_file(self):
        self.write("test/guide/x.cpp", "void f() {\n    if (a) {\n\n      g();\n    }\n}\n")
        self.write("examples/01/x.xml", '<a>\n  <b/>\n</a>\n')
        self.write("GUIDE.md", "```cpp\nif (a) {\n\n  g();\n}\n```\n\n```xml\n<b/>\n```\n")
        self.assertFindsNothing(text_rules.quotes(self.tree))

    def test_code_in_the_guide_that_is_indented_otherwise_within_itself_is_found(self):
        self.write("test/guide/x.cpp", "if (a) {\n  g();\n}\n")
        self.write("GUIDE.md", "```cpp\nif (a) {\n    g();\n}\n```\n")
        self.assertFinds(text_rules.quotes(self.tree), "if (a) {")

    def test_all_code_that_must_be_held_is_known(self):
        self.write("README.md", "```idl\nmodule m {};\n```\n\n```xml\n<a/>\n```\n")
        self.write("GUIDE.md", "```xml\n<a/>\n```\n\n```sh\nls\n```\n")
        self.assertEqual(text_rules.quoted_code(self.tree), [("README.md", "idl", "module m {};\n"), ("GUIDE.md", "xml", "<a/>\n")])

    def test_main_headers_show_their_class_in_use_with_code_that_is_compiled(self):
        self.write("include/skein/task.hpp", "/// A task.\nclass Task;\n")
        self.assertFinds(text_rules.quotes(self.tree), "include/skein/task.hpp: quotes no code")
        self.write("include/skein/task.hpp", "/// A task.\n///\n/// ```cpp\n/// task.run();\n/// ```\nclass Task;\n")
        self.assertFinds(text_rules.quotes(self.tree), "include/skein/task.hpp", "task.run();")
        self.write("test/guide/x.cpp", "void f() {\n  task.run();\n}\n")
        self.assertFindsNothing(text_rules.quotes(self.tree))


class Links(TreeTest):
    def test_a_link_to_what_is_not_there_is_found(self):
        self.write("a/README.md", "See [b](../b.md).\n\n[c](c.png)\n")
        self.write("b.md", "")
        self.assertFinds(text_rules.links(self.tree), "a/README.md:3", "c.png")

    def test_a_link_to_a_heading_that_is_not_there_is_found(self):
        self.write("b.md", "## One `heading`, and more\n")
        self.write("a.md", "[b](b.md#one-heading-and-more) [b](b.md#two) [self](#three)\n\n# Three\n")
        self.assertFinds(text_rules.links(self.tree), "a.md:1", "b.md#two")

    def test_a_file_that_a_profile_names_and_that_is_not_there_is_found(self):
        self.write("examples/01/mission.xml", '<mission dictionary="../b.xml">\n<peer component="a.xml"/><peer component="${x}.xml"/>\n')
        self.write("examples/b.xml", "<dictionary/>")
        self.write("test/mission/profile/mission.xml", '<mission dictionary="nowhere.xml"/>')
        self.assertFinds(text_rules.links(self.tree), "examples/01/mission.xml:2", "a.xml")
        self.write("examples/01/a.xml", "<component/>")
        self.assertFindsNothing(text_rules.links(self.tree))

    def test_links_to_folders_pages_and_in_code_are_taken(self):
        self.write("b/x.txt", "")
        self.write("a.md", "[b](b) [page](https://example.org/x) `f[i](x)`\n\n```cpp\n[](x)\n```\n")
        self.assertFindsNothing(text_rules.links(self.tree))


class Workarounds(TreeTest):
    HEAD = "| symptom | version | upstream | what we do | test | remove when |\n|---|---|---|---|---|---|\n"

    def setUp(self):
        super().setUp()
        self.write("src/dds/x.cpp", "")
        self.write("test/x.cpp", 'TEST_CASE("it is"\n          " so", "[tag]") {}\nTEST_CASE_METHOD(A, "that too") {}\n')

    def check(self, row):
        self.write(text_rules.WORKAROUNDS, self.HEAD + row + "\n")
        return text_rules.workarounds(self.tree)

    def test_a_whole_row_is_taken(self):
        self.assertFindsNothing(self.check(
            '| hangs | 1.0 | none known | [x](x.cpp) waits | [x](../../test/x.cpp): "it is so", "that too" | 1.1 |'))

    def test_a_row_that_lacks_something_is_found(self):
        self.assertFinds(self.check("| hangs | 1.0 | none known | [x](x.cpp) waits | none: rare | |"), "'remove when' is empty")
        self.assertFinds(self.check("| hangs | 1.0 | none known | waits | none: rare | 1.1 |"), "no link to our file")
        self.assertFinds(self.check("| hangs | 1.0 | [x](x.cpp) waits | none: rare | 1.1 |"), "has 5 columns")

    def test_a_test_case_that_is_not_there_is_found(self):
        self.assertFinds(self.check('| hangs | 1.0 | none known | [x](x.cpp) | [x](../../test/x.cpp): "it was so" | 1.1 |'),
                         '"it was so"')


class Compiled(TreeTest):
    def setUp(self):
        super().setUp()
        self.compiler = compile_rules.Compiler(COMPILER, [os.path.join(self.root, "include")])

    def test_a_header_that_does_not_compile_alone_is_found(self):
        self.write("include/skein/x.hpp", "#pragma once\nstd::string text();\n")
        self.write("include/skein/y.hpp", "#pragma once\n#include <string>\nstd::string text();\n")
        self.assertFinds(compile_rules.lone_headers(self.tree, self.compiler), "include/skein/x.hpp", "error")

    def test_a_header_that_does_not_compile_twice_is_found(self):
        self.write("include/skein/x.hpp", "struct X {};\n")
        self.assertFinds(compile_rules.lone_headers(self.tree, self.compiler), "redefinition")

    def test_a_header_that_compiles_as_an_older_standard_is_found(self):
        self.write("include/skein/x.hpp", "#pragma once\nstruct X {};\n")
        self.assertFinds(compile_rules.older_standard(self.tree, self.compiler), "include/skein/x.hpp", "C++20 is needed")
        self.write("include/skein/x.hpp", '#pragma once\n#error "Skein needs C++20"\n')
        self.assertFindsNothing(compile_rules.older_standard(self.tree, self.compiler))

    def test_a_program_whose_search_path_has_an_empty_entry_is_found(self):
        source = self.write("main.cpp", "int main() {}\n")
        for places, found in (("$ORIGIN/../lib", 0), ("$ORIGIN/../lib:", 1), (":/usr/lib", 1)):
            program = os.path.join(self.root, "program")
            subprocess.run([COMPILER, source, "-o", program, f"-Wl,-rpath,{places}"], check=True)
            self.assertEqual(len(list(compile_rules.open_search_paths([self.root]))), found, places)

    def test_generated_code_that_checks_no_version_is_found(self):
        header = self.write("x.idl.hpp", "struct X {};\n")
        self.assertFinds(compile_rules.generated_version(header, self.compiler), "does not check the version")

    def test_generated_code_that_another_version_takes_is_found(self):
        header = self.write("x.idl.hpp", "// SKEIN_IDL_VERSION == 1\n")
        self.assertFinds(compile_rules.generated_version(header, self.compiler), "compiles all the same")

    def test_generated_code_that_checks_its_version_is_taken(self):
        header = self.write("x.idl.hpp", '#pragma once\n#define SKEIN_IDL_VERSION 1\nstatic_assert(SKEIN_IDL_VERSION == 1, "build it anew");\n')
        self.assertFindsNothing(compile_rules.generated_version(header, self.compiler))

    def test_generated_code_that_knows_dds_is_found(self):
        header = self.write("x.idl.hpp", '#include "skein/call.hpp"\n#include "skein/vendor.hpp"\n')
        self.assertFinds(compile_rules.generated_includes(header), "skein/vendor.hpp")


class Definitions(TreeTest):
    def build(self, *sources):
        """A library of one unit a source, with debug information."""
        units = []
        for number, text in enumerate(sources):
            units.append(f"{number}.cpp")
            self.write(units[-1], text)
        subprocess.run([COMPILER, "-std=c++20", "-g", "-shared", "-fPIC", "-o", "library.so", *units], cwd=self.root, check=True)
        return [os.path.join(self.root, "library.so")]

    def test_one_name_for_two_classes_is_found(self):
        libraries = self.build("namespace skein { class Try { int a; }; Try one; }\n", "\nnamespace skein { struct Try { double b; } two; }\n")
        self.assertFinds(definition_rules.one_definition(libraries, self.root), "skein::Try", "0.cpp:1", "1.cpp:2")

    def test_one_class_in_two_units_is_none_too_many(self):
        self.write("try.hpp", "namespace skein { class Try { int a; }; enum class Kind : int { A }; }\n")
        libraries = self.build('#include "try.hpp"\nskein::Try one; skein::Kind kind;\nvoid first() {}\n',
                               'namespace skein {\nenum class Kind : int;\n}\nskein::Kind* known;\n#include "try.hpp"\nskein::Try two;\nvoid second() {}\n')
        self.assertFindsNothing(definition_rules.one_definition(libraries, self.root))

    def test_what_a_unit_keeps_to_itself_may_have_any_name(self):
        text = "namespace skein { namespace { struct Try { int a; }; } Try %s; }\n"
        known = "namespace skein { struct Known { int a; } known; }\n"
        libraries = self.build(text % "one", text % "two", known)
        self.assertFindsNothing(definition_rules.one_definition(libraries, self.root))

    def test_a_library_without_debug_information_is_found(self):
        path = self.write("x.cpp", "int x;\n")
        subprocess.run([COMPILER, "-shared", "-fPIC", "-o", os.path.join(self.root, "x.so"), path], check=True)
        self.assertFinds(definition_rules.one_definition([os.path.join(self.root, "x.so")], self.root), "no debug information")


if __name__ == "__main__":
    unittest.main()
