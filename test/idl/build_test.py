"""skein_add_idl in a project outside the tree: from this tree, and from a copy laid out as an installed package.

build_test.py SKEIN_ROOT CMAKE [unittest's arguments]
"""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT, CMAKE = sys.argv.pop(1), sys.argv.pop(1)
PROJECT = """
cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES CXX)
include({idl}/cmake/SkeinIdl.cmake)
add_library(types OBJECT)
skein_add_idl(TARGET types FILES idl/main.idl idl/geo/point.idl INCLUDES idl)
"""


class BuildTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.write("idl/main.idl", '#include "geo/point.idl"\ninterface I { void f(in Point p); };\n')
        self.write("idl/geo/point.idl", "struct Point { double x; };\n")

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)

    def generated(self, name):
        with open(os.path.join(self.folder, "build/types.idl", name), encoding="utf-8") as stream:
            return stream.read()

    def configure(self, idl):
        self.write("CMakeLists.txt", PROJECT.format(idl=idl))
        self.run_tool(CMAKE, "-S", self.folder, "-B", f"{self.folder}/build", "-G", "Ninja")

    def generate(self):
        """Runs what makes the sources, not the compiler; returns what it said."""
        return self.run_tool(CMAKE, "--build", f"{self.folder}/build", "--target", "types.idl/main.idl.cpp",
                             "types.idl/geo/point.idl.cpp")  # fmt: skip

    def run_tool(self, *command):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout)
        return done.stdout

    def test_a_file_below_an_include_folder_keeps_its_path(self):
        self.configure(f"{ROOT}/idl")
        self.generate()
        self.assertIn('#include "geo/point.idl.hpp"', self.generated("main.idl.hpp"))
        self.assertIn("struct Point", self.generated("geo/point.idl.hpp"))
        self.assertIn('#include "geo/point.dds.idl"', self.generated("main.dds.idl"))

    def test_a_change_of_an_included_file_makes_the_outputs_anew_and_nothing_else_does(self):
        self.configure(f"{ROOT}/idl")
        self.generate()
        before = self.generated("main.idl.cpp")
        self.assertIn("no work to do", self.generate())
        self.write("idl/geo/point.idl", "struct Point { double x; double y; };\n")
        self.generate()
        self.assertNotEqual(before, self.generated("main.idl.cpp"))

    def test_a_change_of_the_compiler_makes_the_outputs_anew(self):
        shutil.copytree(f"{ROOT}/idl", f"{self.folder}/share/skein/idl")
        self.configure(f"{self.folder}/share/skein/idl")
        self.generate()
        self.assertIn("no work to do", self.generate())
        with open(f"{self.folder}/share/skein/idl/compiler/back_end/cpp.py", "a", encoding="utf-8") as stream:
            stream.write("# changed\n")
        self.assertIn("IDL main.idl", self.generate())

    def test_what_a_change_of_the_compiler_leaves_as_it_was_is_not_compiled_anew(self):
        shutil.copytree(f"{ROOT}/idl", f"{self.folder}/share/skein/idl")
        self.configure(f"{self.folder}/share/skein/idl")
        self.generate()
        source = os.path.join(self.folder, "build/types.idl/main.idl.cpp")
        before = os.stat(source).st_mtime_ns
        with open(f"{self.folder}/share/skein/idl/compiler/back_end/cpp.py", "a", encoding="utf-8") as stream:
            stream.write("# changed\n")
        self.generate()
        self.assertEqual(before, os.stat(source).st_mtime_ns)
        self.assertIn("no work to do", self.generate())

    def test_a_project_that_adds_this_tree_builds_the_library_and_nothing_else(self):
        for name in ("ompl", "pugixml", "CLI11", "Boost", "Eigen3"):
            self.write(f"without/{name}Config.cmake", f'message(FATAL_ERROR "{name} is not needed")\n')
        self.write("CMakeLists.txt", f"""
cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES C CXX)
set(CMAKE_PREFIX_PATH ${{CMAKE_CURRENT_SOURCE_DIR}}/without)
add_subdirectory({ROOT} skein)
add_library(types OBJECT)
skein_add_idl(TARGET types FILES idl/main.idl idl/geo/point.idl INCLUDES idl)
target_link_libraries(types PUBLIC skein::skein)
""")
        self.run_tool(CMAKE, "-S", self.folder, "-B", f"{self.folder}/build", "-G", "Ninja")
        self.generate()
        self.assertIn("struct Point", self.generated("geo/point.idl.hpp"))
        steps = self.run_tool(CMAKE, "--build", f"{self.folder}/build", "--", "-n")
        self.assertIn("libskein.so", steps)
        for part in ("src/navigation", "src/mission", "src/command", "src/recording", "src/view", "src/fusion", "examples", "test/"):
            self.assertNotIn(f"skein/{part}", steps)

    def test_a_target_may_have_a_name_that_is_false_as_a_value(self):
        for name in ("n", "no", "off"):
            self.write("CMakeLists.txt", PROJECT.format(idl=f"{ROOT}/idl") + f"add_library({name} OBJECT)\n"
                       f"skein_add_idl(TARGET {name} FILES idl/main.idl INCLUDES idl NAMESPACE {name})\n")  # fmt: skip
            self.run_tool(CMAKE, "-S", self.folder, "-B", f"{self.folder}/build", "-G", "Ninja")
            self.run_tool(CMAKE, "--build", f"{self.folder}/build", "--target", f"{name}.idl/main.idl.hpp")
            with open(f"{self.folder}/build/{name}.idl/main.idl.hpp", encoding="utf-8") as stream:
                self.assertIn(f"namespace {name}", stream.read())
        self.assert_refused("add_library(n OBJECT)\nadd_library(other ALIAS n)\nskein_add_idl(TARGET other FILES idl/main.idl)",
                            "'other' has no code of its own")

    def test_a_second_call_for_one_target_is_told_what_to_write(self):
        self.assert_refused("skein_add_idl(TARGET types FILES idl/main.idl)",
                            "the target 'types' has its IDL from an earlier call; name all of its files in one call, behind FILES")

    def assert_refused(self, lines, said):
        """What CMake says where these lines follow the project's own."""
        self.write("CMakeLists.txt", PROJECT.format(idl=f"{ROOT}/idl") + lines + "\n")
        done = subprocess.run([CMAKE, "-S", self.folder, "-B", f"{self.folder}/build", "-G", "Ninja"],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)  # fmt: skip
        self.assertNotEqual(done.returncode, 0, done.stdout)
        self.assertIn(said, " ".join(done.stdout.split()))

    def test_a_target_without_code_of_its_own_is_refused_when_the_project_is_configured(self):
        for lines in ("add_library(bare INTERFACE)", "add_custom_target(bare)", "add_library(bare ALIAS types)", "add_library(bare STATIC IMPORTED)"):
            with self.subTest(lines):
                self.assert_refused(f"{lines}\nskein_add_idl(TARGET bare FILES idl/main.idl)",
                                    "'bare' has no code of its own; name a target that has, as add_library(NAME STATIC), and link it to 'bare'")  # fmt: skip
        self.assert_refused("skein_add_idl(TARGET typse FILES idl/main.idl)", "there is no target 'typse'; add it before")

    def test_a_file_that_is_missing_is_refused_when_the_project_is_configured_unless_a_rule_makes_it(self):
        lines = "add_library(more OBJECT)\nskein_add_idl(TARGET more FILES idl/mian.idl)"
        self.assert_refused(lines, f"there is no file 'mian.idl' in {self.folder}/idl, which has these: main.idl")
        rule = "add_custom_command(OUTPUT ${CMAKE_CURRENT_SOURCE_DIR}/idl/mian.idl COMMAND cp main.idl mian.idl)\n"
        self.write("CMakeLists.txt", PROJECT.format(idl=f"{ROOT}/idl") + rule + lines + "\n")
        self.run_tool(CMAKE, "-S", self.folder, "-B", f"{self.folder}/build", "-G", "Ninja")

    def test_a_refused_file_stops_the_build_with_its_place(self):
        self.configure(f"{ROOT}/idl")
        self.write("idl/main.idl", "struct S {\n  any x;\n};\n")
        with self.assertRaises(AssertionError) as failure:
            self.generate()
        self.assertIn("main.idl:2:3: error: any is not supported", str(failure.exception))


if __name__ == "__main__":
    unittest.main()
