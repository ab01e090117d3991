"""What the IDL compiler refuses, and that it says where and why; what its output depends on.

compiler_test.py SKEIN_ROOT [unittest's arguments]
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = sys.argv.pop(1)


class CompilerTest(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = self._folder.name
        self.addCleanup(self._folder.cleanup)

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)
        return path

    def compile(self, text, name="x.idl", arguments=()):
        path = self.write(name, text)
        command = ["omniidl", f"-p{ROOT}/idl/compiler", "-bskein", f"-Wbdirectory={self.folder}/out", *arguments, path]
        environment = dict(os.environ, PYTHONDONTWRITEBYTECODE="1")
        done = subprocess.run(command, stderr=subprocess.PIPE, env=environment, text=True, timeout=60)
        return done.returncode, done.stderr.replace(self.folder + "/", "")

    def output(self, name):
        with open(os.path.join(self.folder, "out", name), encoding="utf-8") as stream:
            return stream.read()

    def assert_compiles(self, text, **options):
        code, said = self.compile(text, **options)
        self.assertEqual((code, said), (0, ""))

    def assert_refused(self, text, *findings):
        code, said = self.compile(text)
        self.assertEqual(said.splitlines(), list(findings))
        self.assertNotEqual(code, 0)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "out")), "a refused file has output")


class WhatIsNotSupported(CompilerTest):
    def test_types_without_a_form_on_the_wire_are_refused_with_what_to_use_instead(self):
        refusals = {
            "wstring": "wstring is not supported: DDS vendors disagree on its encoding; use string, which carries UTF-8",
            "wchar": "wchar is not supported: DDS vendors disagree on its size; use string (UTF-8) or unsigned long",
            "long double": "long double is not supported: its format differs between machines; use double",
            "fixed<5,2>": "fixed is not supported: DDS has no such type; use long long with a documented unit",
            "any": "any is not supported: its type would not be known to the reader; use a union of the types that occur",
            "Object": "Object is not supported: a reference names its interface; use the interface as the type",
        }
        for kind, reason in refusals.items():
            with self.subTest(kind):
                self.assert_refused(f"module A {{\n  struct S {{\n    long fine;\n    {kind} x;\n  }};\n}};\n",
                                    f"x.idl:4: error: {reason}")  # fmt: skip

    def test_a_type_is_refused_wherever_it_stands(self):
        refusal = "error: any is not supported: its type would not be known to the reader; use a union of the types that occur"
        for text in (
            "typedef any T;",
            "typedef sequence<any> T;",
            "typedef any T[3];",
            "union U switch (long) { case 0: any x; };",
            "exception E { any x; };",
            "interface I { void f(in any x); };",
            "interface I { any f(); };",
            "interface I { attribute any x; };",
        ):
            with self.subTest(text):
                self.assert_refused(text, f"x.idl:1: {refusal}")

    def test_declarations_that_cannot_travel_are_refused(self):
        refusals = {
            "valuetype V { public long x; };": "valuetype is not supported: objects do not travel by value; use a struct",
            "valuetype V long;": "boxed valuetypes are not supported: use a sequence with a bound of 1 for what may be absent",
            "abstract interface I {};": "abstract interfaces are not supported: use an ordinary interface or a struct",
            "local interface I {};": "local interfaces are not supported: nothing of them travels; write a C++ class",
            "native N;": "native is not supported: it has no form on the wire; use a type of IDL",
            'interface I { void f() context ("a"); };': "context clauses are not supported: pass what they carry as a parameter",
        }
        for text, reason in refusals.items():
            with self.subTest(text):
                self.assert_refused(text, f"x.idl:1: error: {reason}")

    def test_what_uses_a_refused_declaration_is_refused_and_points_at_the_cause(self):
        self.assert_refused(
            "struct S {\n  wstring text;\n};\ntypedef sequence<S> T;\nexception E { T x; };\n"
            "interface I {\n  void f() raises (E);\n};\n",
            "x.idl:2: error: wstring is not supported: DDS vendors disagree on its encoding; use string, which carries UTF-8",
            "x.idl:4: error: S cannot be used, see x.idl:2",
            "x.idl:5: error: T cannot be used, see x.idl:2",
            "x.idl:7: error: E cannot be raised, see x.idl:2",
        )

    def test_every_refusal_of_a_file_is_said(self):
        code, said = self.compile("struct S {\n  any a;\n  wchar b;\n};\ntypedef fixed<3,1> F;\n")
        self.assertEqual(re.findall(r"^x.idl:(\d+): error", said, re.MULTILINE), ["2", "3", "5"])
        self.assertEqual(code, 1)

    def test_use_of_a_refused_declaration_of_an_included_file_is_refused(self):
        self.write("other.idl", "module O {\n  typedef any Bad;\n  struct Good { long x; };\n};\n")
        self.assert_refused(
            '#include "other.idl"\nstruct S {\n  O::Bad x;\n  O::Good y;\n};\n',
            "x.idl:3: error: O::Bad cannot be used, see other.idl:2",
            "x.idl:4: error: O::Good cannot be used, see other.idl:2",
        )

    def test_an_included_file_that_is_refused_is_left_out_where_nothing_of_it_is_used(self):
        self.write("other.idl", "typedef any Bad;\n")
        code, said = self.compile('#include "other.idl"\nstruct S { long x; };\n')
        self.assertEqual(code, 0)
        self.assertEqual(said, "x.idl:1: warning: 'other.idl' cannot be compiled, see other.idl:1; nothing of it is used, "
                         "and it is left out\n")  # fmt: skip
        self.assertNotIn("other.idl", self.output("x.idl.hpp"))


class Clashes(CompilerTest):
    def test_names_that_become_one_in_cpp_are_refused(self):
        self.assert_refused(
            "interface I {\n  void f(in long x);\n};\nstruct I_f_In { long y; };\n",
            "x.idl:4: error: the C++ name I_f_In would be both I_f_In of I::f and I_f_In; rename one of them",
        )
        self.assert_refused(
            "interface I {};\nstruct IProxy { long y; };\n",
            "x.idl:2: error: the C++ name IProxy would be both the proxy of I and IProxy; rename one of them",
        )

    def test_names_that_differ_only_in_case_are_two_names(self):
        self.assert_compiles("struct Problem { long x; }; interface I { void plan(in Problem problem); };")


class Pragmas(CompilerTest):
    def test_a_key_that_is_no_member_is_refused_with_a_suggestion(self):
        self.assert_refused("struct S { long number; };\n#pragma keylist S numbr\n",
                            "x.idl:2: error: #pragma keylist: S has no member 'numbr' (did you mean 'number'?)")  # fmt: skip
        self.assert_refused("struct Sample { long number; };\n#pragma keylist Sampel number\n",
                            "x.idl:2: error: #pragma keylist: no struct 'Sampel' here (did you mean 'Sample'?)")  # fmt: skip

    def test_a_key_of_a_type_that_cannot_be_one_is_refused(self):
        self.assert_refused(
            "struct S { sequence<long> x; };\n#pragma keylist S x\n",
            "x.idl:2: error: #pragma keylist: 'x' cannot be a key; keys are numbers, text, enumerations, and arrays and "
            "structs of these",
        )

    def test_idempotent_names_an_operation_that_exists(self):
        self.assert_refused("interface I {\n  void plan();\n  #pragma idempotent plan\n  #pragma idempotent plam\n"
                            "  #pragma idempotent plan\n};\n",
                            "x.idl:4: error: #pragma idempotent: no operation 'plam' here (did you mean 'plan'?)")  # fmt: skip

    def test_a_stream_is_an_operation_with_a_result_and_nothing_else_that_comes_back(self):
        self.assert_compiles("interface I {\n  long count(in long sink);\n  #pragma stream count\n};\n#pragma stream I::count\n")
        header = self.output("x.idl.hpp")
        self.assertIn("virtual void count(std::int32_t sink, ::skein::StreamSink<std::int32_t>& sink_) = 0;", header)
        self.assertIn("::skein::Stream<std::int32_t> count(std::int32_t sink);", header)
        self.assertIn("// count is a stream", self.output("x.dds.idl"))

    def test_what_cannot_be_a_stream_is_refused(self):
        refusal = "must have a result, which becomes the stream, and no out parameters"
        self.assert_refused("interface I {\n  void f();\n  long g(out long x);\n  #pragma stream f\n  #pragma stream g\n};\n",
                            f"x.idl:4: error: #pragma stream: 'f' {refusal}",
                            f"x.idl:5: error: #pragma stream: 'g' {refusal}")  # fmt: skip
        self.assert_refused("interface I {\n  attribute long x;\n  #pragma stream x\n};\n",
                            "x.idl:3: error: #pragma stream: 'x' is an attribute; use an operation")  # fmt: skip
        self.assert_refused("interface I {\n  long count();\n  #pragma stream cuont\n};\n",
                            "x.idl:3: error: #pragma stream: no operation 'cuont' here (did you mean 'count'?)")  # fmt: skip
        self.assert_refused("interface I {\n  long count();\n  #pragma idempotent count\n  #pragma stream count\n};\n",
                            "x.idl:4: error: 'count' cannot be both idempotent and a stream: a stream is never repeated")  # fmt: skip

    def test_a_misspelt_pragma_is_refused_and_a_foreign_one_warned_about(self):
        self.assert_refused("struct S { long x; };\n#pragma keylst S x\n",
                            "x.idl:2: error: unknown pragma 'keylst' (did you mean 'keylist'?)")  # fmt: skip
        code, said = self.compile("struct S { long x; };\n#pragma hh whatever\n")
        self.assertEqual((code, said), (0, "x.idl:2: warning: unknown pragma 'hh' is passed over\n"))


class Signatures(CompilerTest):
    BASE = "struct S { long x; double y; }; exception E { S s; }; interface I { S f(in S a, out string b) raises (E); };"

    def signature(self, text):
        self.assert_compiles(text)
        return re.search(r'"f", 0x\w+U, (0x\w+)ULL', self.output("x.idl.cpp"))[1]

    def test_any_change_of_what_travels_changes_the_signature(self):
        seen = {self.signature(self.BASE)}
        changes = [("long x", "short x"), ("long x", "long z"), ("double y", "double y; long z"), ("out string", "out S"),
                   ("out string b", "inout string b"), ("S f(", "long f("), (" raises (E)", ""), ("{ S s; }", "{ S s; S t; }"),
                   ("string b", "string<9> b")]  # fmt: skip
        for old, new in changes:
            self.assertIn(old, self.BASE)
            seen.add(self.signature(self.BASE.replace(old, new, 1).replace("string<9> b", "Nine b", 1).replace(
                "struct S", "typedef string<9> Nine; struct S", 1)))  # fmt: skip
        self.assertEqual(len(seen), 1 + len(changes))

    def test_names_of_types_and_comments_do_not_change_the_signature(self):
        base = self.signature(self.BASE)
        self.assertEqual(base, self.signature(re.sub(r"\bS\b", "Renamed", self.BASE)))
        self.assertEqual(base, self.signature("// A comment.\n" + self.BASE))

    def test_a_recursive_type_has_a_signature(self):
        text = "struct T; typedef sequence<T> Ts; struct T { Ts c; }; interface I { T f(in T a); };"
        self.assertNotEqual(self.signature(text), self.signature(text.replace("Ts c;", "Ts c; long x;")))


class Dependencies(CompilerTest):
    def test_the_depfile_names_all_included_files_and_the_compiler(self):
        self.write("sub/a.idl", '#include "b.idl"\nstruct A { long x; };\n')
        self.write("sub/b.idl", "struct B { long x; };\n")
        self.write("far/c.idl", "struct C { long x; };\n")
        depfile = os.path.join(self.folder, "x.d")
        self.assert_compiles('#include "sub/a.idl"\n#include <c.idl>\nstruct S { A a; C c; };\n',
                             arguments=[f"-I{self.folder}/far", f"-Wbdepfile={depfile}"])  # fmt: skip
        with open(depfile, encoding="utf-8") as stream:
            text = stream.read()
        for name in ("x.idl", "sub/a.idl", "sub/b.idl", "far/c.idl"):
            self.assertIn(f" {self.folder}/{name}", text)
        self.assertIn("idl/compiler/skein/model.py", text)
        self.assertTrue(text.startswith(f"{self.folder}/out/x.idl.hpp {self.folder}/out/x.idl.cpp"))

    def test_only_direct_includes_are_included_again(self):
        self.write("a.idl", '#include "b.idl"\nstruct A { B x; };\n')
        self.write("b.idl", "struct B { long x; };\n")
        self.assert_compiles('#include "a.idl"\n#ifdef NEVER\n#include "never.idl"\n#endif\nstruct S { A a; };\n')
        self.assertEqual(re.findall(r'#include "(\w+\.idl)', self.output("x.idl.hpp")), ["a.idl"])


class Documentation(CompilerTest):
    def test_comments_directly_above_become_documentation_and_others_do_not(self):
        self.assert_compiles(
            "// Copyright of the file.\n\ninterface I {\n"
            "  long x(); ///< behind\n"
            "  /// Of f.\n  void f();\n"
            "  /**\n   * Of g,\n   * in two lines.\n   */\n  void g();\n"
            "  // Far away.\n\n\n\n  void h();\n};\n"
        )
        header = self.output("x.idl.hpp")
        self.assertIn("  /// Of f.\n  virtual void f() = 0;\n", header)
        self.assertIn("  /// Of g,\n  /// in two lines.\n  virtual void g() = 0;\n", header)
        self.assertNotIn("Copyright", header)
        self.assertNotIn("Far away", header)
        self.assertNotIn("behind", header)


if __name__ == "__main__":
    unittest.main()
