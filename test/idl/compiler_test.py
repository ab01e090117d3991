"""What the IDL compiler refuses, and that it says where and why; what its output depends on.

compiler_test.py SKEIN_ROOT [unittest's arguments]
"""

import os
import re
import shutil
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

    def assert_clash(self, text, line, name, one, other):
        reason = f"the flattened name {name} would be both {one} and {other}; rename one of them"
        self.assert_refused(text, f"x.idl:{line}: error: {reason}")

    def test_names_that_become_one_in_the_flattened_idl_are_refused(self):
        self.assert_clash("interface I {};\nstruct I_Request { long y; };\n",
                          2, "I_Request", "I_Request of I", "I_Request")  # fmt: skip
        self.assert_clash("interface I {\n  void f();\n};\nconst long I_f_Hash = 1;\n",
                          4, "I_f_Hash", "I_f_Hash of I::f", "I_f_Hash")  # fmt: skip
        self.assert_clash("exception E {};\nconst long E_Ex_Hash = 1;\n",
                          2, "E_Ex_Hash", "E_Ex_Hash of E", "E_Ex_Hash")  # fmt: skip
        self.assert_clash("interface I {\n  enum E { A };\n};\ninterface J {\n  enum F { A };\n};\n",
                          5, "A", "the enumerator I::A", "the enumerator J::A")  # fmt: skip
        self.assert_clash("module m {\n  module I_T {\n    struct S { long x; };\n  };\n"
                          "  interface I {\n    struct T { long x; };\n  };\n};\n",
                          6, "m_I_T", "the module m::I_T", "m::I::T")  # fmt: skip

    def test_names_that_become_one_in_the_c_of_idlc_are_refused(self):
        self.assert_clash("module a_b {\n  struct c { long x; };\n};\nmodule a {\n  struct b_c { long x; };\n};\n",
                          5, "a_b_c", "a_b::c", "a::b_c")  # fmt: skip
        self.write("other.idl", "module a_b {\n  struct c { long x; };\n};\n")
        self.assert_clash('#include "other.idl"\nmodule a {\n  interface b {\n    struct c { long x; };\n  };\n};\n',
                          4, "a_b_c", "a_b::c", "a::b::c")  # fmt: skip

    def test_members_that_become_one_in_the_flattened_idl_are_refused(self):
        self.assert_clash("interface I {\n  long f(out long return_);\n};\n", 2, "I_f_Out.return_",
                          "the parameter return_ of I::f", "the result of I::f")  # fmt: skip
        self.assert_clash("interface I {\n  void unknownOp();\n};\n",
                          1, "I_Call.unknownOp", "the case of unknown operations", "I::unknownOp")  # fmt: skip
        self.assert_clash("interface I {\n  void attribute_get_x();\n  readonly attribute long x;\n};\n",
                          1, "I_Call.attribute_get_x", "I::attribute_get_x", "I::_get_x")  # fmt: skip
        self.assert_clash("module a {\n  exception E {};\n};\nmodule b {\n  exception E {};\n};\n"
                          "interface I {\n  void f() raises (a::E, b::E);\n};\n",
                          8, "I_f_Result.e_ex", "a::E", "b::E")  # fmt: skip

    def test_names_that_differ_only_in_case_are_two_names(self):
        self.assert_compiles("struct Problem { long x; }; interface I { void plan(in Problem problem); };")


class Pragmas(CompilerTest):
    COUNTS = "there a nested struct counts by its own keylist, or as a whole without one; make both agree"

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

    def test_keys_are_in_the_flattened_idl_and_stand_in_the_order_of_the_members(self):
        self.assert_compiles("struct P { long a; short b; long c; };\n#pragma keylist P b a\n"
                             "struct S { long before; P part; long d; };\n#pragma keylist S d part.b part.a\n")  # fmt: skip
        flattened = self.output("x.dds.idl")
        self.assertIn("struct P {\n  @key long a;\n  @key short b;\n  long c;\n};", flattened)
        self.assertIn("struct S {\n  long before;\n  @key P part;\n  @key long d;\n};", flattened)
        self.assertIn("the key (part.a, part.b, d)", self.output("x.idl.hpp"))

    def test_a_nested_struct_is_a_key_as_a_whole_or_by_its_own_keylist(self):
        for pragmas in ("#pragma keylist S part", "#pragma keylist S part.a part.b",
                        "#pragma keylist P a\n#pragma keylist S part.a", "#pragma keylist S part.a\n#pragma keylist P a",
                        "#pragma keylist P b a\n#pragma keylist S part"):  # fmt: skip
            with self.subTest(pragmas):
                self.assert_compiles("struct P { long a; long b; };\nstruct S { P part; long c; };\n" + pragmas + "\n")
        self.assert_compiles("struct Q { long a; long b; };\nstruct P { Q inner; long c; };\nstruct S { P part; };\n"
                             "#pragma keylist Q b\n#pragma keylist P inner.b\n#pragma keylist S part.inner.b\n")  # fmt: skip

    def test_a_key_that_would_be_another_one_in_dds_is_refused(self):
        def refused(pragmas, line, here, in_dds):
            self.assert_refused(
                "struct P { long a; long b; };\nstruct S { P part; long c; };\n" + pragmas + "\n",
                f"x.idl:{line}: error: #pragma keylist: the key of S is {here}, but in DDS {in_dds}: {self.COUNTS}",
            )

        refused("#pragma keylist S part.a", 3, "part.a", "part.a, part.b")
        refused("#pragma keylist P a\n#pragma keylist S part.b c", 4, "part.b, c", "part.a, c")
        refused("#pragma keylist S part\n#pragma keylist P a", 3, "part.a, part.b", "part.a")
        refused("#pragma keylist S part part.a", 3, "part.a, part.b, part.a", "part.a, part.b")

    def test_what_is_whole_is_so_down_to_its_last_member(self):
        # As idlc does it: a struct without keys that is a key takes no notice of the keys below it.
        self.assert_compiles("struct Q { long a; long b; };\nstruct P { Q inner; };\nstruct S { P part; };\n"
                             "#pragma keylist Q a\n#pragma keylist S part\n")  # fmt: skip

    def test_keys_by_the_keylist_of_another_file_are_compared_too(self):
        self.write("other.idl", "struct P { long a; long b; };\n#pragma keylist P a\nstruct Plain { long a; long b; };\n")
        self.assert_compiles('#include "other.idl"\nstruct S { P part; Plain plain; };\n#pragma keylist S part.a plain\n')
        shutil.rmtree(os.path.join(self.folder, "out"))
        self.assert_refused('#include "other.idl"\nstruct S { Plain plain; };\n#pragma keylist S plain.a\n',
                            "x.idl:3: error: #pragma keylist: the key of S is plain.a, but in DDS plain.a, plain.b: "
                            + self.COUNTS)  # fmt: skip
        self.assert_refused('#include "other.idl"\n#pragma keylist Plain a\n',
                            "x.idl:2: error: #pragma keylist: Plain is of another file, where its keylist must stand")  # fmt: skip

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

    STREAM = ("typedef long Number;\nexception No {};\ninterface Base {\n  long plan(in string task);\n  %s\n};\ninterface I : Base {\n"
              "  Number improve(in string plan) raises (No);\n  #pragma stream improve %s\n};\n")  # fmt: skip

    def test_a_stream_may_name_the_operation_whose_result_it_brings_by_default(self):
        self.assert_compiles(self.STREAM % ("", "plan"))
        self.assertIn("  /// By default: the result of plan(), and no other.\n"
                      "  virtual void improve(const std::string& plan, ::skein::StreamSink<::Number>& sink);\n",
                      self.output("x.idl.hpp"))  # fmt: skip
        self.assertIn("void I::improve(const std::string& plan, ::skein::StreamSink<::Number>& sink) {\n"
                      "  sink.push(this->plan(plan));\n}\n", self.output("x.idl.cpp"))  # fmt: skip
        self.assert_compiles("interface I {\n  long f();\n  long g();\n};\n#pragma stream I::f g\n")
        self.assertIn("  sink.push(this->g());\n", self.output("x.idl.cpp"))

    def test_a_streams_default_is_an_operation_that_exists_and_fits(self):
        place = "x.idl:9: error: #pragma stream: "
        self.assert_refused(self.STREAM % ("", "plam"), place + "I has no operation 'plam' (did you mean 'plan'?)")
        self.assert_refused(self.STREAM % ("attribute long level;", "level"), place + "'level' is an attribute; use an operation")
        refusals = {
            "improve": "it is a stream itself",
            "long other();": "its parameters are others",
            "long other(in long task);": "its parameters are others",
            "long other(inout string task);": "its parameters are others",
            "long other(in string task, out long x);": "its parameters are others",
            "void other(in string task);": "its result is another",
            "unsigned long other(in string task);": "its result is another",
            "string other(in string task);": "its result is another",
        }
        for declared, reason in refusals.items():
            with self.subTest(declared):
                name = "other" if "other" in declared else declared
                text = self.STREAM % (declared if name == "other" else "", name)
                self.assert_refused(text, f"{place}'{name}' cannot stand in for 'improve': {reason}")
        self.assert_refused(
            "exception No {};\ninterface I {\n  long f() raises (No);\n  long g();\n  #pragma stream g f\n};\n",
            "x.idl:5: error: #pragma stream: 'f' cannot stand in for 'g': it raises No, which the stream does not",
        )
        self.assert_refused(
            "interface I {\n  long f();\n  long g();\n  #pragma stream g f f\n};\n",
            "x.idl:4: error: #pragma stream names one stream and at most the operation whose result it brings by default; "
            "write a pragma for each stream",
        )
        self.assert_refused(
            "interface I {\n  long f();\n  long g();\n  #pragma stream g f\n  #pragma stream f\n};\n",
            "x.idl:4: error: #pragma stream: 'f' cannot stand in for 'g': it is a stream itself",
        )

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
