"""What the IDL compiler refuses, and that it says where and why; what its output depends on.

compiler_test.py SKEIN_ROOT [unittest's arguments]
"""

import os
import re
import shutil
import sys
import tempfile
import time
import unittest
from unittest import mock

sys.dont_write_bytecode = True
from compiler_run import run_compiler

ROOT = sys.argv.pop(1)
ANY = "any is not supported: its type would not be known to the reader; use a union of the types that occur"


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
        code, said = run_compiler(ROOT, "--out", f"{self.folder}/out", *arguments, path)
        return code, self.findings(said.replace(self.folder + "/", ""))

    @staticmethod
    def findings(said):
        """Without columns and without the lines that are shown below; syntax_test.py is about these."""
        found = re.findall(r"^(\S+?:\d+)(?::\d+)?(: (?:error|warning): .*\n)", said, re.MULTILINE)
        if said and not found:
            raise AssertionError(said)
        return "".join(place + reason for place, reason in found)

    @staticmethod
    def errors(said):
        return [line for line in said.splitlines() if ": error: " in line]

    def output(self, name):
        with open(os.path.join(self.folder, "out", name), encoding="utf-8") as stream:
            return stream.read()

    def assert_compiles(self, text, **options):
        code, said = self.compile(text, **options)
        self.assertEqual((code, self.errors(said)), (0, []), said)

    def assert_refused(self, text, *findings):
        code, said = self.compile(text)
        self.assertEqual(self.errors(said), list(findings))
        self.assertNotEqual(code, 0)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "out")), "a refused file has output")


class WhatIsNotSupported(CompilerTest):
    def test_types_without_a_form_on_the_wire_are_refused_with_what_to_use_instead(self):
        refusals = {
            "fixed<5,2>": "fixed is not supported: DDS has no such type; use double, or long long with a documented unit",
            "any": ANY,
            "Object": "Object is not supported: a reference names its interface; use the interface as the type",
        }
        for kind, reason in refusals.items():
            with self.subTest(kind):
                self.assert_refused(f"module A {{\n  struct S {{\n    long fine;\n    {kind} x;\n  }};\n}};\n",
                                    f"x.idl:4: error: {reason}")  # fmt: skip

    def test_a_type_is_refused_wherever_it_stands(self):
        refusal = "error: " + ANY
        for text in (
            "union U switch (long) { case 0: any x; };",
            "exception E { any x; };",
            "struct S { sequence<any, 3> x[2]; };",
            "interface I { void f(in any x); };",
            "interface I { any f(); };",
            "interface I { attribute any x; };",
        ):
            with self.subTest(text):
                self.assert_refused(text, f"x.idl:1: {refusal}")

    def test_what_is_refused_only_where_it_would_travel(self):
        for text, said in {
            "typedef sequence<any> T[3];": "the typedef T is left out: " + ANY,
            "native T;": "the native T is left out: it has no form on the wire",
            "valuetype T { public long x; };": "the valuetype T is left out: objects do not travel by value; use a struct",
            "abstract valuetype T { void f(); };": "the valuetype T is left out: objects do not travel by value; use a struct",
            "valuetype T;": "the valuetype T is left out: objects do not travel by value; use a struct",
            "valuetype T long;": "the boxed valuetype T is left out: objects do not travel by value; use @optional, or a sequence with a "
            "bound of 1, for what may be absent",
            "local interface T {};": "the local interface T is left out: nothing of it travels; write a C++ class",
            "abstract interface T;": "the abstract interface T is left out: it may stand for an object that travels by value; use an "
            "ordinary interface or a struct",
        }.items():
            with self.subTest(text):
                self.assertEqual(self.compile(text), (0, f"x.idl:1: warning: {said}\n"))
                shutil.rmtree(os.path.join(self.folder, "out"))
                self.assert_refused(text + "\nstruct S { T x; };\n", "x.idl:2: error: T cannot be used, see x.idl:1")

    def test_declarations_that_are_refused_by_name(self):
        refusals = {
            "component C {};": "components are not supported: an entity is written in C++; use its interfaces",
            "module M<typename T> { struct S { T x; }; };": "template modules are not supported: write out the module for each of its "
            "arguments",
            'interface I { void f() context ("a"); };': "context clauses are not supported: pass what they carry as a parameter",
        }
        for text, reason in refusals.items():
            with self.subTest(text):
                self.assert_refused(text, f"x.idl:1: error: {reason}")

    def test_what_uses_a_refused_declaration_is_refused_and_points_at_the_cause(self):
        self.assert_refused(
            "struct S {\n  any text;\n};\ntypedef sequence<S> T;\nexception E { T x; };\n"
            "interface I {\n  void f() raises (E);\n};\n",
            "x.idl:2: error: " + ANY,
            "x.idl:5: error: T cannot be used, see x.idl:2",
            "x.idl:7: error: E cannot be raised, see x.idl:2",
        )

    def test_every_refusal_of_a_file_is_said(self):
        code, said = self.compile("struct S {\n  any a;\n  sequence<Object> b;\n};\nstruct F {\n  fixed<3,1> x; };\n")
        self.assertEqual(re.findall(r"^x.idl:(\d+): error", said, re.MULTILINE), ["2", "3", "6"])
        self.assertEqual(code, 1)

    def test_use_of_a_refused_declaration_of_an_included_file_is_refused(self):
        self.write("other.idl", "module O {\n  struct Bad { any x; };\n  struct Good { long x; };\n};\n")
        self.assert_refused(
            '#include "other.idl"\nstruct S {\n  O::Bad x;\n  O::Good y;\n};\n',
            "x.idl:3: error: O::Bad cannot be used, see other.idl:2: " + ANY,
            "x.idl:4: error: O::Good cannot be used, see other.idl:2: " + ANY,
        )

    def test_an_included_file_that_is_refused_is_left_out_where_nothing_of_it_is_used(self):
        self.write("other.idl", "struct Bad { any x; };\n")
        code, said = self.compile('#include "other.idl"\nstruct S { long x; };\n')
        self.assertEqual(code, 0)
        self.assertEqual(said, f"x.idl:1: warning: 'other.idl' cannot be compiled, see other.idl:1: {ANY}; nothing of it is used, "
                         "and it is left out\n")  # fmt: skip
        self.assertNotIn("other.idl", self.output("x.idl.hpp"))


class WhatMakesNoSense(CompilerTest):
    """What reads as IDL, and cannot be meant."""

    def assert_finding(self, text, said):
        code, findings = self.compile(text + "\n")
        self.assertEqual((code, self.errors(findings)), (1, ["x.idl:1: error: " + said]))

    def test_names(self):
        self.assert_finding("struct S { Speed x; }; struct Sped { long x; };",
                            "there is no 'Speed' here (did you mean 'Sped', which is declared further down, at x.idl:1?)")
        self.assert_finding("interface I { void f() raises (NotFond); }; exception NotFound { };",
                            "there is no 'NotFond' here (did you mean 'NotFound', which is declared further down, at x.idl:1?)")
        self.assert_finding("struct Sped { long x; }; struct S { Speed x; };", "there is no 'Speed' here (did you mean 'Sped'?)")
        self.assert_finding("module A { enum E { ONE }; }; const A::E X = A::OEN;", "there is no 'OEN' in A (did you mean 'ONE'?)")
        self.assert_finding("struct S { long x; }; enum S { A };", "'S' is declared twice in one scope, first at x.idl:1")
        self.assert_finding("struct S { long x; short x; };", "there is a member 'x' already, at x.idl:1")
        self.assert_finding("interface I { void f(in long x, in long x); };", "there is a parameter 'x' already")
        self.assert_finding("interface I { void f(); long f(); };", "'f' is declared already, as I::f at x.idl:1; IDL has no overloading, name it otherwise")
        self.assert_finding("module M { }; struct S { M x; };", "'M' is a module, no type")
        self.assert_finding("struct S; struct T { S x; }; struct S { long x; };",
                            "S is not defined yet: make the member @external or @optional, or use a sequence of it")  # fmt: skip
        self.assert_finding("struct S;", "S is announced here and defined nowhere")
        self.assert_finding("interface I; interface J : I {};", "the base of J must be an interface that is defined before it")
        self.assert_finding("struct S { long x; }; interface I { void f() raises (S); };", "'S' is no exception")
        self.assert_finding("struct S { long octet; };", "'octet' is a keyword of IDL and no name; write '_octet', which is the name 'octet'")
        self.assert_finding("struct S { int32_t x; };", "there is no 'int32_t' here; write 'int32'")
        self.assert_finding("struct S { Sequence<long> x; };",
                            "'<' stands behind 'Sequence' (did you mean 'sequence'?) where a declaration or a type is expected")  # fmt: skip

    def test_what_is_used_before_it_is_declared_is_told_to_move_up(self):
        for use in ("struct A { Pose p; };", "struct A : Pose { long x; };", "interface I { void f(in Pose p); };", "typedef sequence<Pose> Poses;"):
            with self.subTest(use):
                self.assert_refused(f"{use}\n\nstruct Pose {{ double x; }};\n",
                                    "x.idl:1: error: 'Pose' is declared further down, at x.idl:3; move its declaration up, before its first use")  # fmt: skip
        self.assert_refused("struct A { long x[N]; };\nconst long N = 3;\n",
                            "x.idl:1: error: 'N' is declared further down, at x.idl:2; move its declaration up, before its first use")

    def test_a_size_that_is_not_known_is_told_to_be_a_constant(self):
        remedy = "there is no 'n' here; a size is a number or a constant: const unsigned long n = 10;"
        for member in ("double x[n]", "sequence<double, n> x", "string<n> x"):
            with self.subTest(member):
                self.assert_finding(f"struct S {{ {member}; }};", remedy)

    def test_a_constant_that_is_wrong_is_told_once_and_not_where_it_is_used(self):
        self.assert_finding('const long N = "three"; struct S { long x[N]; }; typedef sequence<long, N> T;', "a whole number is expected here, for long")

    def test_values_without_end(self):
        said = "a value of {} would be without end: make a member by which it contains itself @optional, or a sequence"
        self.assert_finding("struct S; struct S { @external S x; };", said.format("S"))
        code, findings = self.compile("union U; struct S { @external U x; }; union U switch (long) { case 1: S x; };")
        self.assertEqual((code, self.errors(findings)), (1, [f"x.idl:1: error: {said.format(name)}" for name in "SU"]))

    def test_annotations(self):
        self.assert_finding("struct S { long a @key; };", "an annotation stands before what it is about, not behind")
        self.assert_finding("struct S { @default long a; };", "@default needs a value: @default(1)")
        self.assert_finding("@bit_bound() enum E { A };", "@bit_bound needs a number: @bit_bound(1)")
        self.assert_finding("@mutable struct S { @id(268435455) long a; long b; };",
                            "a member's identifier is from 0 to 268435455, not 268435456")  # fmt: skip

    def test_constants(self):
        self.assert_finding("const octet X = 256;", "256 does not fit into octet, which goes from 0 to 255")
        self.assert_finding("const long X = 1 << 31;", "2147483648 does not fit into long, which goes from -2147483648 to 2147483647")
        self.assert_finding("const long X = 5 / (3 - 3);", "division by zero")
        self.assert_finding("const float X = 1e39;", "the number does not fit into float")
        self.assert_finding("const long X = 1.5;", "a whole number is expected here, for long")
        self.assert_finding("const long X = 089;", "'089' begins with 0 and so is octal, which has no 8 and no 9")
        self.assert_finding('const boolean X = "no";', "TRUE or FALSE is expected here, for boolean")
        self.assert_finding("const string<2> X = \"abc\";", "the text has 3 bytes, and 2 are allowed")
        self.assert_finding("const char X = '\\777';", "'\\777' is no byte: the greatest is '\\377'")
        self.assert_finding('const string X = "\\q";', "there is no escape '\\q'; a backslash itself is '\\\\'")
        self.assert_finding("typedef long A[0];", "0 is no size: it is at least 1 and at most 2147483647")
        self.assert_finding("const long X = 1 << 64;", "a shift goes by 0 to 63, not by 64")

    def test_unions_enumerations_and_bits(self):
        self.assert_finding("union U switch (double) { case 1: long x; };",
                            "a union is switched by a whole number, a character, a boolean or an enumeration")  # fmt: skip
        self.assert_finding("union U switch (long) { case 1: long x; case 1: long y; };", "there is a case 1 already, at x.idl:1")
        self.assertEqual(
            self.compile("union U switch (boolean) { case TRUE: long x; case FALSE: long y; default: long z; };"),
            (0, "x.idl:1: warning: the default of U can never be chosen, as every value has its own case, and is left out\n"),
        )
        shutil.rmtree(os.path.join(self.folder, "out"))
        self.assert_finding("enum E { @value(2) A, @value(1) B, C };", "another enumerator has the value 2 already")
        self.assert_finding("enum E { @default_literal A, @default_literal B };", "'A' is the default literal already")
        self.assert_finding("@bit_bound(4) bitmask M { @position(4) a };", "the position 4 is none of the 4 bits")
        self.assert_finding("@bit_bound(65) bitmask M { a };", "@bit_bound is from 1 to 64 here, not 65")
        self.assert_finding("bitset B { bitfield<60> a; bitfield<5> b; };", "a bitset has 1 to 64 bits, not 65")
        self.assert_finding("bitset B { bitfield<9, octet> a; };",
                            "a bit field of 9 bits is held by a boolean or a whole number that has as many")  # fmt: skip
        self.assert_finding("struct S { map<double, long> x; };",
                            "the key of a map is a number, a character, text, a boolean or an enumeration")  # fmt: skip

    def test_types_that_grow(self):
        self.assert_finding("@mutable struct S { @id(1) long a; @id(1) long b; };",
                            "'b' would have the identifier 1, as 'a' has; give one of them another by @id")  # fmt: skip
        self.assert_finding("@mutable struct S { @id(268435456) long a; };",
                            "a member's identifier is from 0 to 268435455, not 268435456")  # fmt: skip
        self.assert_finding("struct S { @key @optional long a; };", "'a' cannot be a key and optional: each sample has its key")
        self.assert_finding("@extensibility(OPEN) struct S { long a; };", "@extensibility is FINAL, APPENDABLE or MUTABLE")
        self.assert_finding("@mutable union U switch (long) { @id(0) case 1: long x; };",
                            "a member's identifier is from 1 to 268435455, not 0")  # fmt: skip

    def test_oneway(self):
        refusal = "'f' is oneway, so that nothing can come back: no result, no out parameter, no exception"
        for operation in ("oneway long f();", "@oneway void f(out long x);"):
            self.assert_finding(f"interface I {{ {operation} }};", refusal)


    def test_a_conditional_that_does_not_end(self):
        self.assert_refused("#ifndef G\n#define G\nstruct S { long x; };\n", "x.idl:1: error: this #ifndef does not end; add the #endif")

    def test_what_several_bases_declare_alike_is_named_with_its_base(self):
        bases = "interface A { typedef long T; };\ninterface B { typedef string T; };\n"
        self.assert_refused(bases + "interface C : A, B { attribute T x; };\n",
                            "x.idl:3: error: 'T' is inherited from several bases, see x.idl:1 and x.idl:2; write which, as in Base::T")  # fmt: skip
        self.assert_compiles(bases + "interface C : A, B { attribute A::T x; };\n")
        self.assert_compiles("interface R { typedef long T; };\ninterface A : R { };\ninterface B : R { };\n"
                             "interface C : A, B { attribute T x; };\n")  # fmt: skip

    def test_an_attribute_is_no_array(self):
        self.assert_refused("interface I { attribute long v[3]; };\n",
                            "x.idl:1: error: the attribute 'v' cannot be an array; give the array a name by typedef, and use that")  # fmt: skip

    def test_words_of_other_languages(self):
        self.assert_refused("struct S { unsigned int x; };\n", "x.idl:1: error: IDL has no 'int'; write 'long' or 'int32'")
        for member, finding in (
            ("std::string x", "'string' is a keyword of IDL and no name; write 'string' without 'std::'"),
            ("void x", "'void' is a keyword of IDL and no type of a member or a parameter: an operation alone may return nothing; write the type"),
            ("long void", "'void' is a keyword of IDL and no name; write '_void', which is the name 'void'"),
            ("int x", "there is no 'int' here; write 'long' or 'int32'"),
            ("bool x", "there is no 'bool' here; write 'boolean'"),
            ("float64 x", "there is no 'float64' here; write 'double'"),
            ("vector<double> x", "IDL has no 'vector<'; write 'sequence<double>'"),
            ("std::vector<long> x", "IDL has no 'vector<'; write 'sequence<long>'"),
            ("std::optional<double> x", "IDL has no 'optional<'; write '@optional double'"),
            ("std::array<double, 3> x", "IDL has no 'array<'; write 'double NAME[3]'"),
        ):
            with self.subTest(member):
                self.assert_finding(f"struct S {{ {member}; }};", finding)
        self.assert_finding("struct T { long y; }; class S { long x; };",
                            "IDL has no 'class'; write struct NAME { ... }; for data, interface NAME { ... }; for operations")
        self.assert_finding("enum class E { A };", "IDL has no 'enum class'; leave 'class' out: in C++ it becomes one")
        self.assert_finding("struct S { bitfield<3> a; };", "bit fields stand in a bitset: bitset NAME { bitfield<3> a; };")
        self.assert_finding("# a comment", "there is no directive '#a'; a comment begins with '//' in IDL")
        self.assert_finding('#inlcude "y.idl"', "there is no directive '#inlcude' (did you mean 'include'?); a comment begins with '//' in IDL")
        self.assert_finding("struct S { long x; # a comment\n};",
                            "'#' begins a directive at the beginning of a line; a comment begins with '//' in IDL")

    def test_arrays_references_and_constants_of_other_languages(self):
        sequence = "an array has a size; for any number of elements write "
        for member, finding in (
            ("float64[] x", sequence + "sequence<double> x"),
            ("unsigned long[] x", sequence + "sequence<unsigned long> x"),
            ("double x[]", sequence + "sequence<double> x"),
            ("long[3] x", "the size of an array stands behind its name; write long x[3]"),
            ("string* x", "IDL has no references and no pointers; write string x"),
            ("const long x", "a member or a parameter has no 'const' in IDL; leave it out: what is passed 'in' cannot change"),
        ):
            with self.subTest(member):
                self.assert_finding(f"struct S {{ {member}; }};", finding)
        self.assert_finding("interface I { void f(in const string& x); };", "IDL has no references and no pointers; write in string x")
        self.assert_finding("interface I { void f(in long a, in double[] x); };", sequence + "in sequence<double> x")

    def test_a_letter_beyond_ascii_is_shown_where_it_stands(self):
        path = self.write("x.idl", "struct S {\n  double größe;\n};\n")
        _, said = run_compiler(ROOT, "--check", path)
        self.assertIn("x.idl:2:12: error: a name in IDL has the letters A to Z, digits and '_'; 'größe' has 'ö'\n", said)

    def test_an_array_that_makes_every_value_huge(self):
        remedy = "use a sequence, which takes what it holds"
        self.assertEqual(self.compile("struct S { octet x[1000000000]; };\n"),
                         (0, f"x.idl:1: warning: this array takes 953 MiB in every value and every message; {remedy}\n"))  # fmt: skip
        self.assertEqual(self.compile("struct P { double x; long y[30000]; }; struct S { P x[30000]; };\n"),
                         (0, f"x.idl:1: warning: this array takes 3433 MiB (a message has less than 2048) in every value and every message; {remedy}\n"))
        self.assertEqual(self.compile("struct S { octet x[8000000]; string y[100000000]; };\n"), (0, ""))

    def test_words_that_are_not_closed(self):
        self.assert_refused("const char A = 'abc';\n", "x.idl:1: error: a character in quotes is one character; text stands in double quotes")
        self.assert_refused('const string A = "abc;\n', "x.idl:1: error: this text does not end on its line; add the '\"' (texts that follow each "
                            "other are joined)")  # fmt: skip

    def test_what_idl_says_by_other_means(self):
        self.assert_finding("struct S { double x = 3; };", "a member has no value in IDL; its default is told by @default(3) double x;")
        self.assert_finding("interface I { double f(in long a, in double x = 3); };", "a parameter has no default in IDL; leave '= 3' out")
        self.assert_finding("interface I { double x; };",
                            "an interface has operations and attributes; write double x(); or attribute double x;")
        self.assert_finding("struct S { long a; double f(); };", "members are data; operations stand in an interface")
        self.assert_finding("interface I { double f() const; };", "IDL has no const operations; leave 'const' out")
        self.assert_finding("module m { double f(in double x); };", "operations stand in an interface: interface NAME { ... };")
        self.assert_finding("struct S { sequence<long> x = {}; };", "a member has no value in IDL; its default is told by @default(VALUE) sequence<long> x;")
        self.assert_finding("interface I { async double f(); };",
                            "IDL has no 'async'; leave it out: every operation can also be called asynchronously, by async_NAME in C++")

    def test_another_language_is_named_at_once(self):
        for text, language in (
            ('// a comment\nsyntax = "proto3";\nmessage A { int32 x = 1; }', "Protocol Buffers"),
            ("package lift;\nmessage A { int32 x = 1; }", "Protocol Buffers"),
            ("<?xml version='1.0'?>\n<types/>", "XML"),
            ('{"type": "object"}', "JSON"),
            ("namespace a { struct S { int x; }; }",
             "C++; IDL declares data by struct NAME { ... };, operations by interface NAME { ... };"),
            ("int64 a\nint64 b\n---\nint64 sum", "a message, a service or an action of ROS 2; IDL declares struct NAME { double x; };"),
            ("float64 x\nfloat64[] y\n", "a message, a service or an action of ROS 2; IDL declares struct NAME { double x; };"),
        ):
            with self.subTest(language):
                line = 2 if text.startswith("//") else 1
                self.assert_refused(text + "\n", f"x.idl:{line}: error: this is no IDL: it looks like {language}")

    def test_more_errors_of_syntax_than_are_shown(self):
        code, said = self.compile("".join(f"struct A{i} {{ long 3; }};\n" for i in range(30)))
        self.assertIn("error: these were 20 errors of syntax; what follows was not read", said)
        self.assertEqual(len(self.errors(said)), 21)
        code, said = self.compile("}\n" * 30)
        self.assertIn("x.idl:20: error: these were 20 errors of syntax", said)

    def test_keys_without_a_member_take_no_time(self):
        self.assert_compiles("struct E { }; struct S { @key E x[2147483647]; @key long y; };\n")
        self.assert_compiles("struct T0 { };\n" + "".join(f"struct T{i} {{ T{i - 1} a; T{i - 1} b; }};\n" for i in range(1, 30)) +
                             "struct S { @key T29 t; @key long y; };\n")  # fmt: skip

    def test_an_include_within_a_module(self):
        self.write("part.idl", "struct Part { long x; };\n")
        self.write("macros.idl", "#define SIZE 3\n")
        self.assert_refused('module m {\n#include "part.idl"\nstruct S { Part p; };\n};\n',
                            "x.idl:2: error: 'part.idl' is included within 'm'; include it outside, and write the module in it")  # fmt: skip
        self.assert_compiles('module m {\n#include "macros.idl"\nstruct S { long x[SIZE]; };\n};\n#include "part.idl"\n')

    def test_a_command_line_that_is_wrong_has_an_exit_code_of_its_own(self):
        code, said = run_compiler(ROOT, "--ouput", "out", "x.idl")
        self.assertEqual(code, 64)
        self.assertIn("skein-idl: unrecognized arguments: --ouput", said)
        self.assertIn("see `skein-idl --help`", said)

    def test_the_folder_of_the_output_is_named_as_for_other_commands(self):
        path = self.write("x.idl", "struct S { long x; };\n")
        for option in ("--output", "--out"):
            folder = f"{self.folder}/by{option}"
            self.assertEqual(run_compiler(ROOT, option, folder, path), (0, ""))
            self.assertTrue(os.path.exists(f"{folder}/x.idl.hpp"))

    def test_a_name_with_quotes_is_a_file_like_others(self):
        code, said = self.compile("struct S { Nope x; };\n", name='a"b.idl')
        self.assertNotEqual(code, 0, said)


class Annotations(CompilerTest):
    def test_a_flag_may_be_said_not_to_be_set(self):
        self.assert_compiles("const boolean NO = FALSE;\nstruct S { @key(FALSE) long a; @optional(NO) long b; @key(TRUE) long c; };\n")
        self.assertEqual(re.findall(r"@\w+|\b[abc];", self.output("x.dds.idl"))[-4:], ["a;", "b;", "@key", "c;"])
        self.assert_refused_anew("struct S { @key(3) long a; };\n", "x.idl:1: error: TRUE or FALSE is expected here, for boolean")

    def test_autoid_is_by_hash_and_holds_for_what_a_module_declares(self):
        self.assert_compiles("@mutable @autoid struct A { long color; };\n@mutable @autoid(HASH) union B switch (long) { case 1: long color; };\n"
                             "@autoid(HASH) module m { @mutable struct C { long color; };\n"
                             "  @mutable @autoid(SEQUENTIAL) struct D { long color; }; };\n@mutable struct E { long color; };\n")  # fmt: skip
        color, discriminator = "262528368", "0"
        self.assertEqual(re.findall(r"writer.member\((\d+),", self.output("x.idl.cpp")), [color, discriminator, color, color, "0", "0"])

    def assert_refused_anew(self, text, *findings):
        shutil.rmtree(os.path.join(self.folder, "out"))
        self.assert_refused(text, *findings)


class ReservedNames(CompilerTest):
    def test_macros_and_names_of_the_generated_code_get_an_underscore(self):
        self.assert_compiles("enum Source { CLOCK_REALTIME, BIG_ENDIAN, EINVAL, NAMED };\n"
                             "interface I { struct Proxy { long x; }; void type_support(in Proxy p); };\n")  # fmt: skip
        header = self.output("x.idl.hpp")
        for name in ("CLOCK_REALTIME_", "BIG_ENDIAN_", "EINVAL_", "using Proxy_ =", "type_support_(", "NAMED,"):
            self.assertIn(name, header)


class Constants(CompilerTest):
    def test_the_greatest_float_is_a_float_however_it_is_written(self):
        self.assert_compiles("const float A = 3.40282347e+38; const float B = -3.4028235e38; const double C = 1.7976931348623157e308;\n")

    def test_expressions_are_those_of_exact_integers(self):
        values = {
            "long A = -2147483648;": "inline constexpr std::int32_t A = -2147483648;",
            "long A = -7 / 2;": "A = -3;",
            "long A = -7 % 3;": "A = -1;",
            "long long A = (1 << 63) - 1;": "A = 9223372036854775807LL;",
            "unsigned long A = ~0;": "A = 4294967295U;",
            "octet A = ~1 & 0x0F | 0x30 ^ 017;": "A = 63;",
            "double A = 1 / 4.0;": "A = 0.25;",
            "char A = '\\x41';": "A = 'A';",
            'string A = "a\\"" "\\101\\n";': 'A = "a\\"A\\012";',
        }
        for text, expected in values.items():
            with self.subTest(text):
                self.assert_compiles(f"const {text}\n")
                self.assertIn(expected, self.output("x.idl.hpp"))


class PublishedIdl(CompilerTest):
    """What is less strict than the language, and written so in IDL that is in use."""

    def test_loose_constants(self):
        self.assert_compiles(
            "enum E { A, B };\nconst long B_NUMBER = B;\nconst char C = 0x41;\nconst wchar W = 'S';\nconst boolean Y = 1;\n"
            "const boolean Z = true;\nunion U switch (char) { case 0: long x; };\n"
        )
        header = self.output("x.idl.hpp")
        for expected in ("B_NUMBER = 1;", "C = 'A';", "W = L'S';", "Y = true;", "Z = true;"):
            self.assertIn(expected, header)

    def test_a_member_may_be_named_as_its_type(self):
        self.assert_compiles("struct x { short x; };\nunion u switch (long) { case 1: long u; };\nexception e { long e; };\ninterface i { void i(); };\n")
        for expected in ("std::int16_t x_ = 0;", "bool holds_u_()", "std::int32_t e_ = 0;", "virtual void i_()"):
            self.assertIn(expected, self.output("x.idl.hpp"))

    def test_a_name_may_begin_with_two_underscores(self):
        self.assert_compiles("struct S { octet __dummy; };\n")
        self.assertIn("_dummy = 0;", self.output("x.idl.hpp"))

    def test_an_array_of_structs_with_keys_of_their_own_is_no_key(self):
        self.assert_refused(
            "struct A { @key long k; long o; };\nstruct B { @key A a[2]; };\n",
            "x.idl:2: error: @key: 'a' cannot be a key; keys are numbers, text, enumerations, and arrays and structs of these",
        )

    def test_keys_in_the_forms_of_older_tools(self):
        for text in ("struct S { long a; //@key\n  long b; };\n", "struct S { @Key long a; long b; };\n"):
            self.assert_compiles(text)
            self.assertIn("/// The DDS key hash of the key (a).", self.output("x.idl.hpp"))
            self.assertIn("@key long a;", self.output("x.dds.idl"))

    def test_a_key_member_counts_by_its_own_keys_whatever_else_it_has(self):
        self.assert_compiles("struct A { @key long k; @optional long o; sequence<long> s; };\nstruct B { @key A a; };\n")
        self.assertIn("the key (a.k)", self.output("x.idl.hpp"))

    def test_annotations_may_have_parameters_that_are_named_as_keywords(self):
        self.assert_compiles("struct S { @value(default = False) boolean b; };\n")

    def test_a_comment_by_verbatim_may_have_any_escape(self):
        self.assert_compiles('@verbatim(language = "comment", text = "from \\(a\\)") struct S { long x; };\n')
        self.assertIn("/// from (a)", self.output("x.idl.hpp"))


class Namespaces(CompilerTest):
    TEXT = "module m { struct S { long x; }; exception E { S s; }; interface I { S f(in S a) raises (E); }; };"

    def test_a_namespace_is_around_all_names_of_cpp_and_nothing_else_changes(self):
        self.assert_compiles(self.TEXT)
        source, flattened = self.output("x.idl.cpp"), self.output("x.dds.idl")
        self.assert_compiles(self.TEXT, arguments=["--namespace", "north::v1"])
        self.assertIn("namespace north::v1::m {", self.output("x.idl.hpp"))
        self.assertEqual(self.output("x.dds.idl"), flattened)
        self.assertEqual(self.output("x.idl.cpp").replace("::north::v1", "").replace("north::v1::", ""), source)


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

    def test_names_that_become_one_by_a_maps_pairs_are_refused(self):
        self.assert_clash("struct S { map<long, long> m; };\nstruct S_m_Pair { long x; };\n",
                          2, "S_m_Pair", "the pairs of S_m", "S_m_Pair")  # fmt: skip

    def test_two_of_one_scope_that_differ_only_in_case_are_warned_about_with_both_places(self):
        for text, one, other in (
            ("struct S { double x;\n double X; };", "x", "X"),
            ("exception E { double x;\n double X; };", "x", "X"),
            ("union U switch (long) { case 0: long a;\n case 1: long A; };", "a", "A"),
            ("interface I { void shape();\n void Shape(); };", "shape", "Shape"),
            ("interface I { attribute long a;\n attribute long A; };", "a", "A"),
            ("interface I { void f(in long q,\n in long Q); };", "q", "Q"),
            ("enum E { red,\n Red };", "red", "Red"),
            ("module M { struct Pose { long x; };\n struct pose { long x; }; };", "Pose", "pose"),
        ):
            with self.subTest(text):
                code, said = self.compile(text + "\n")
                self.assertEqual((code, said), (0, f"x.idl:2: warning: '{other}' and '{one}', at x.idl:1, are one name in IDL, where case does not count: "
                                 "other compilers may refuse them; rename one\n"))  # fmt: skip
        self.assertEqual(self.compile("struct S { double x; };\ninterface S2 { void f(in S s); };\n"), (0, ""))

    def test_names_that_differ_only_in_case_are_two_names(self):
        self.assert_compiles("struct Problem { long x; }; interface I { void plan(in Problem problem); };")


class Pragmas(CompilerTest):
    COUNTS = "there a nested struct counts by its own keylist, or as a whole without one; make both agree"

    def test_a_key_that_is_no_member_is_refused_with_a_suggestion(self):
        self.assert_refused("struct S { long number; };\n#pragma keylist S numbr\n",
                            "x.idl:2: error: #pragma keylist: S has no member 'numbr' (did you mean 'number'?)")  # fmt: skip
        for bare in ("keylist", "DCPS_DATA_KEY"):
            self.assert_refused(f"struct S {{ long number; }};\n#pragma {bare}\n", "x.idl:2: error: #pragma keylist: it needs a struct and its key members")
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

    def test_annotated_keys_are_those_of_the_keylist(self):
        def text(annotated, pragma):
            return ("struct P { %s long a; short b; };\nstruct S { long before; %s P part; %s long d; };\n" % annotated) + pragma

        self.assert_compiles(text(("", "", ""), "#pragma keylist P a\n#pragma keylist S part.a d\n"))
        by_pragma = self.output("x.idl.hpp"), self.output("x.idl.cpp"), self.output("x.dds.idl")
        self.assert_compiles(text(("@key", "@key", "@key"), ""))
        self.assertEqual(by_pragma, (self.output("x.idl.hpp"), self.output("x.idl.cpp"), self.output("x.dds.idl")))
        self.assertIn("the key (part.a, d)", by_pragma[0])

    def test_an_older_form_is_honoured_with_a_warning(self):
        warning = "x.idl:2: warning: #pragma keylist is older than IDL 4: write @key before each member that is a key\n"
        for pragma in ("#pragma keylist S x", '#pragma DCPS_DATA_KEY "S x"'):
            self.assertEqual(self.compile("struct S { long x; };\n" + pragma), (0, warning))
            self.assertIn("@key long x", self.output("x.dds.idl"))

    def test_a_misspelt_pragma_is_refused_and_a_foreign_one_warned_about(self):
        self.assert_refused("struct S { long x; };\n#pragma keylst S x\n",
                            "x.idl:2: error: unknown pragma 'keylst' (did you mean 'keylist'?)")  # fmt: skip
        code, said = self.compile("struct S { long x; };\n#pragma hh whatever\n")
        self.assertEqual((code, said), (0, "x.idl:2: warning: unknown pragma 'hh' is passed over\n"))
        code, said = self.compile("interface I {\n  void f();\n#pragma stream f\n};\n")
        self.assertEqual((code, said), (0, "x.idl:3: warning: #pragma stream is passed over: of Skein's operations, write @stream before "
                                        "the operation\n"))  # fmt: skip


class Streams(CompilerTest):
    def test_a_stream_is_an_operation_with_a_result_and_nothing_else_that_comes_back(self):
        self.assert_compiles("interface I {\n  @stream long count(in long sink);\n};\n")
        header = self.output("x.idl.hpp")
        self.assertIn("virtual void count(std::int32_t sink, ::skein::StreamSink<std::int32_t>& sink_) = 0;", header)
        self.assertIn("::skein::Stream<std::int32_t> count(std::int32_t sink) const;", header)
        self.assertIn("// count is a stream", self.output("x.dds.idl"))

    STREAM = ("typedef long Number;\nexception No {};\ninterface Base {\n  long plan(in string task);\n  %s\n};\ninterface I : Base {\n"
              '  @stream(by_default = "%s") Number improve(in string plan) raises (No);\n};\n')  # fmt: skip

    def test_a_stream_may_name_the_operation_whose_result_it_brings_by_default(self):
        self.assert_compiles(self.STREAM % ("", "plan"))
        self.assertIn("  /// By default: the result of plan(), and no other.\n"
                      "  virtual void improve(const std::string& plan, ::skein::StreamSink<::Number>& sink);\n",
                      self.output("x.idl.hpp"))  # fmt: skip
        self.assertIn("void I::improve(const std::string& plan, ::skein::StreamSink<::Number>& sink) {\n"
                      "  sink.push(this->plan(plan));\n}\n", self.output("x.idl.cpp"))  # fmt: skip
        self.assert_compiles('interface I {\n  @stream(by_default = "g") long f();\n  long g();\n};\n')
        self.assertIn("  sink.push(this->g());\n", self.output("x.idl.cpp"))

    def test_a_streams_default_is_an_operation_that_exists_and_fits(self):
        place = "x.idl:8: error: @stream: "
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
            'exception No {};\ninterface I {\n  long f() raises (No);\n  @stream(by_default = "f") long g();\n};\n',
            "x.idl:4: error: @stream: 'f' cannot stand in for 'g': it raises No, which the stream does not",
        )
        self.assert_refused(
            'interface I {\n  @stream long f();\n  @stream(by_default = "f") long g();\n};\n',
            "x.idl:3: error: @stream: 'f' cannot stand in for 'g': it is a stream itself",
        )

    def test_what_cannot_be_a_stream_is_refused(self):
        refusal = "must have a result, which becomes the stream, and no out parameters"
        self.assert_refused("interface I {\n  @stream void f();\n  @stream long g(out long x);\n};\n",
                            f"x.idl:2: error: @stream: 'f' {refusal}",
                            f"x.idl:3: error: @stream: 'g' {refusal}")  # fmt: skip
        self.assert_refused("interface I {\n  @stream attribute long x;\n};\n",
                            "x.idl:2: error: @stream: 'x' is an attribute; use an operation")  # fmt: skip
        self.assert_refused("interface I {\n  @idempotent @stream long count();\n};\n",
                            "x.idl:2: error: 'count' cannot be both idempotent and a stream: a stream is never repeated")  # fmt: skip

    def test_an_unknown_annotation_is_kept_with_a_suggestion(self):
        self.assertEqual(
            self.compile("interface I {\n  @strem long f();\n};\n"),
            (0, "x.idl:2: warning: unknown annotation '@strem' is kept and has no effect (did you mean 'stream'?)\n"),
        )
        self.assertEqual(self.compile("@annotation Mine {};\n@Mine struct S { @Mine long x; };\n"), (0, ""))

    def test_an_annotation_that_does_nothing_where_it_stands_is_told(self):
        for text, annotation, place, use in (
            ("@appendable module M { struct S { long x; }; };", "appendable", "a module", "types"),
            ("@appendable interface I { void f(); };", "appendable", "an interface", "types"),
            ("@key interface I { void f(); };", "key", "an interface", "members of structs"),
            ("@idempotent struct S { long x; };", "idempotent", "a struct", "operations"),
            ("@key typedef long T;", "key", "a typedef", "members of structs"),
            ("struct S { @stream long x; };", "stream", "a member", "operations"),
            ("struct S { sequence<@key long> x; };", "key", "an element", "members of structs"),
            ("union U switch (@key long) { case 1: long x; };", "key", "a discriminator", "members of structs"),
            ("interface I { void f(in @optional string x); };", "optional", "a parameter", "members of structs, and for operations"),
            ("enum E { @position(2) A };", "position", "an enumerator", "bits of a bitmask"),
        ):
            with self.subTest(text):
                self.assertEqual(self.compile(text + "\n"),
                                 (0, f"x.idl:1: warning: '@{annotation}' has no effect on {place}: it is for {use}\n"))  # fmt: skip
        self.assertEqual(self.compile("interface I { @idempotent oneway void f(); };\n"),
                         (0, "x.idl:1: warning: '@idempotent' has no effect on 'f', which is oneway: without an answer nothing is repeated\n"))  # fmt: skip
        self.assertEqual(self.compile("@key(FALSE) interface I { @optional void f(); };\n@autoid(HASH) module M { @final struct S { @id(3) long x; }; };\n"
                                      "@bit_bound(8) bitmask B { @position(2) A };\n"), (0, ""))  # fmt: skip


class Sizes(CompilerTest):
    """A small file does not keep the compiler busy, and a large one is refused before it does."""

    def test_numbers_of_any_length_in_any_base(self):
        for number in ("1" + "0" * 5000, "0x" + "f" * 5000, "0" + "7" * 6000):
            self.assert_refused(f"const long X = {number};\n", "x.idl:1: error: the number is too large")

    def test_a_source_that_grows_without_end(self):
        laughs = "".join(f"#define A{i} {f'A{i - 1} ' * 10}\n" for i in range(1, 10))
        self.assert_refused(f"#define A0 long x;\n{laughs}struct S {{ A9 }};\n",
                            "x.idl:1: error: with what it includes this file has more than 2 MiB; divide it into files that include each other")  # fmt: skip
        code, said = self.compile('#include "/dev/zero"\nstruct S { long x; };\n')
        self.assertEqual(code, 1)
        self.assertIn("out of memory", said)
        path = self.write("y.idl", "")
        os.truncate(path, 3 << 20)
        self.assertEqual(run_compiler(ROOT, path), (1, f"{path}: error: the file has more than 2 MiB; divide it into files that include each other\n"))

    def test_the_time_for_a_declaration_grows_with_its_size_and_not_with_the_square(self):
        def seconds(declaration):
            begin = time.process_time()
            self.assert_compiles(declaration)
            return time.process_time() - begin

        for text in ("struct S {{ long {} ; }};", "enum E {{ {} }};"):
            few, many = (text.format(", ".join(f"a{i}" for i in range(count))) + "\n" for count in (500, 8000))
            self.assertLess(seconds(many), 100 * seconds(few))

    def test_more_errors_than_anybody_reads(self):
        code, said = self.compile("".join(f"struct S{i} {{ T{i} x; }};\n" for i in range(5000)))
        self.assertEqual((code, len(self.errors(said))), (1, 501))
        self.assertIn("x.idl:500: error: these were 500 errors; what follows was not looked at\n", said)
        self.assertEqual(len(self.errors(self.compile("#define\n" * 600)[1])), 501)

    def test_what_draws_on_a_terminal_is_escaped(self):
        path = self.write("a\u202eb.idl", "struct \u009bS { long x; };\n")
        _, said = run_compiler(ROOT, path)
        self.assertIn("a\\xe2\\x80\\xaeb.idl:1:8: error: the character '\\xc2\\x9b' has no meaning here\nstruct \\xc2\\x9bS {", said)
        _, said = run_compiler(ROOT, f"{self.folder}/no\u009bne.idl")
        self.assertIn("no\\xc2\\x9bne.idl: error: there is no such file", said)


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

    def test_whether_an_operation_may_be_missing_does_not_change_the_signature(self):
        optional = self.BASE.replace("S f(", "@optional S f(")
        self.assertEqual(self.signature(self.BASE), self.signature(optional))
        told = re.compile(r'"f", 0x.*?"", (true|false)\}', re.DOTALL)
        self.assertEqual(told.search(self.output("x.idl.cpp"))[1], "true")
        self.signature(self.BASE)
        self.assertEqual(told.search(self.output("x.idl.cpp"))[1], "false")

    def test_a_recursive_type_has_a_signature(self):
        text = "struct T; typedef sequence<T> Ts; struct T { Ts c; }; interface I { T f(in T a); };"
        self.assertNotEqual(self.signature(text), self.signature(text.replace("Ts c;", "Ts c; long x;")))


class Languages(CompilerTest):
    IDL = "struct S {\n  long x;\n  @optional map<long, string> m;\n};\ninterface I {\n  void f(\n    in sequence<map<long, S>> a);\n};\n"

    def compile_without_maps(self, language):
        """As if `map` were new and that language had no form of it yet."""
        self.compile("struct S { long x; };\n")  # loads the compiler's modules
        with mock.patch.object(sys.modules["model"].Map, "languages", ("c++",)):
            return self.compile(self.IDL, arguments=["--language", language])

    def test_a_template_that_a_language_lacks_is_refused_where_it_stands(self):
        for language, spoken in ("ada", "Ada"), ("c", "C"), ("java", "Java"), ("python", "Python"):
            with self.subTest(language):
                refusal = f"error: {spoken} has no form of the type map<…> yet; use a struct, or --language c++\n"
                self.assertEqual(self.compile_without_maps(language), (1, f"x.idl:3: {refusal}x.idl:6: {refusal}"))

    def test_the_languages_that_have_it_compile_it(self):
        self.assertEqual(self.compile_without_maps("c++"), (0, ""))


class Dependencies(CompilerTest):
    def test_the_depfile_names_all_included_files_and_the_compiler(self):
        self.write("sub/a.idl", '#include "b.idl"\nstruct A { long x; };\n')
        self.write("sub/b.idl", "struct B { long x; };\n")
        self.write("far/c.idl", "struct C { long x; };\n")
        depfile = os.path.join(self.folder, "x.d")
        self.assert_compiles('#include "sub/a.idl"\n#include <c.idl>\nstruct S { A a; C c; };\n',
                             arguments=[f"-I{self.folder}/far", "--depfile", depfile])  # fmt: skip
        with open(depfile, encoding="utf-8") as stream:
            text = stream.read()
        for name in ("x.idl", "sub/a.idl", "sub/b.idl", "far/c.idl"):
            self.assertIn(f" {self.folder}/{name}", text)
        self.assertIn("idl/compiler/model.py", text)
        self.assertTrue(text.startswith(f"{self.folder}/out/x.dds.idl {self.folder}/out/x.idl.hpp {self.folder}/out/x.idl.cpp"))

    def test_corbas_sequences_are_there_to_be_included(self):
        for name in ("orb.idl", "tao/LongSeq.pidl"):
            self.assert_compiles(f'#include <{name}>\nstruct S {{ CORBA::LongSeq x; }};\n')
            self.assertEqual(re.findall(r'#include "(\S+idl)\.hpp', self.output("x.idl.hpp")), [name])

    def test_only_included_files_that_declare_something_have_headers(self):
        self.write("macros.h", "#define COUNT 3\n")
        self.write("all.idl", '#include "one.idl"\n')
        self.write("one.idl", "struct One { long x; };\n")
        self.assert_compiles('#include "macros.h"\n#include "all.idl"\nstruct S { One x[COUNT]; };\n')
        self.assertEqual(re.findall(r'#include "(\w+\.\w+)\.hpp', self.output("x.idl.hpp")), ["all.idl"])

    def test_a_path_that_leads_out_of_a_folder_and_back_is_that_from_the_folder(self):
        os.mkdir(os.path.join(self.folder, "inner"))
        self.write("inner/one.idl", "struct One { long x; };\n")
        folder = os.path.basename(self.folder)
        self.assert_compiles(f'#include "../{folder}/inner/one.idl"\nstruct S {{ One x; }};\n', arguments=["-I", self.folder])
        self.assertIn('#include "inner/one.idl.hpp"', self.output("x.idl.hpp"))

    def test_what_is_included_twice_is_declared_once(self):
        """As in the IDL that ROS 2 makes, which guards nothing and repeats its typedefs."""
        self.write("one.idl", "module m {\n  typedef double double__36[36];\n  struct One { double__36 x; };\n};\n")
        self.write("two.idl", '#include "one.idl"\nmodule m { typedef double double__36[36]; struct Two { One x; double__36 y; }; };\n')
        self.assert_compiles('#include "one.idl"\n#include "two.idl"\nstruct S { m::One one; m::Two two; };\n')

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
