"""What the front end reads, by the clauses of OMG IDL 4.2, and how it says what it cannot read.

syntax_test.py SKEIN_ROOT [unittest's arguments]
"""

import contextlib
import io
import logging
import os
import sys
import tempfile
import unittest

ROOT = sys.argv.pop(1)
sys.path.insert(0, f"{ROOT}/idl/compiler")
sys.dont_write_bytecode = True
from compiler_run import run_compiler

try:
    import lark
    from front_end import parser, source
    from report import Report
except ImportError:
    print("Skipped: python3-lark is not installed")
    sys.exit(77)


class SyntaxTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "wb") as stream:
            stream.write(text if isinstance(text, bytes) else text.encode())
        return path

    def check(self, text, *arguments):
        with contextlib.redirect_stdout(io.StringIO()):
            code, said = run_compiler(ROOT, "--check", *arguments, self.write("x.idl", text))
        return code, said.replace(self.folder + "/", "").splitlines()

    def assert_reads(self, text, *definitions):
        """It has a tree, whatever it means."""
        report = Report()
        self.assertIsNotNone(parser.parse(source.Source(self.write("x.idl", text), [], definitions, report), report))
        self.assertEqual(report.errors, 0)

    def assert_says(self, text, *lines):
        self.assertEqual(self.check(text), (1, list(lines)))


class Clauses(SyntaxTest):
    def test_7_4_1_core_data_types(self):
        self.assert_reads(
            "const long long A = -(1 << 4) % 3 | 0x0F & ~2 ^ 017; const char C = '\\x41'; const string S = \"a\" \"b\";\n"
            "typedef sequence<sequence<octet, A>> T, U[2][A + 1]; struct F; typedef sequence<F> Fs;\n"
            "module M { struct P { }; struct Q : P { long port, home[3]; ::M::P p; Fs children; }; };\n"
            "enum E { X, Y }; union V switch (E) { case X: case Y: long a; default: string<9> b; };\n"
        )

    def test_7_4_2_any_and_7_4_3_interfaces(self):
        self.assert_reads(
            "exception No { string why; }; interface A; local interface L { void f(in any a); }; abstract interface B { };\n"
            "interface A : B { readonly attribute long x raises (No); attribute any y getraises (No) setraises (No);\n"
            "  oneway void f(); Object g(in long a, out long b, inout long c, long d) raises (No) context (\"c\"); };\n"
        )

    def test_7_4_5_to_7_4_12_value_types_and_components(self):
        self.assert_reads(
            "interface I { }; valuetype V; valuetype Box long; abstract valuetype W { void f(); };\n"
            "custom valuetype V : truncatable W supports I { public long a; private I b; factory make(in long x); };\n"
            "component C supports I { provides I p; uses multiple I u; attribute long a; };\n"
            "home H manages C primarykey V { factory make(); finder find(); }; eventtype Ev { public long x; };\n"
            "module T<typename K, const long n> { struct S { K k; }; }; module T<long, 3> Made;\n"
        )

    def test_7_4_13_extended_data_types(self):
        self.assert_reads(
            "typedef map<string, sequence<int8>> M; typedef map<uint64, int16, 10> N;\n"
            "bitmask F { @position(3) a, b }; bitset B { bitfield<3> a; bitfield<4>; bitfield<10, int16> c; };\n"
            "union U switch (wchar) { case L'a': int32 x; }; union O switch (@key uint8) { case 1: map<long, long> x; };\n"
        )

    def test_7_4_15_annotations(self):
        self.assert_reads(
            "@annotation Mine { long value default 3; enum K { A, B }; K kind default A; any other; };\n"
            '@final @Mine(value = 4, kind = B) @verbatim(language = "c++", text = "a" "b") struct S { @key ::S::X x; @mine::own(3) long y; };\n'
            "@service interface I { @oneway void f(in @range(min = -1, max = 1) long a, @unit(\"m\") in long b); };\n"
            "@bit_bound(8) enum E { @value(3) A, @default_literal B };\n"
        )


class Findings(SyntaxTest):
    def test_a_finding_has_place_line_and_mark(self):
        self.assert_says(
            "struct S {\n\tlong  a\n\tlong b;\n};\n",
            "x.idl:3:2: error: 'long' stands where ';' or ',' or '[' is expected",
            "\tlong b;",
            "\t^",
        )

    def test_every_error_of_a_file_is_said(self):
        _, said = self.check("struct { };\nmodule M {\n  enum E { };\n  struct S { sequence<> x; long y; };\n};\ninterfaces I;\n")
        self.assertEqual([line.split(": ")[0] for line in said if ": error: " in line],
                         ["x.idl:1:8", "x.idl:3:12", "x.idl:4:23", "x.idl:6:1"])  # fmt: skip

    def test_a_file_that_ends_too_early(self):
        self.assert_says("module M {\n  struct S { };\n", "x.idl:2:15: error: the file ends, but the '{' of line 1 is open; add the '};'", "  struct S { };", " " * 14 + "^")

    def test_a_file_that_is_missing(self):
        self.assert_says(
            '#include "y.idl"\n',
            "x.idl:1:10: error: there is no file 'y.idl' here or in the folders given by -I; add the folder that holds it",
            '#include "y.idl"',
            "         ^",
        )

    def test_an_error_in_an_included_file_is_shown_there(self):
        self.write("y.idl", "struct Y {\n  long;\n};\n")
        self.assert_says('\n#include "y.idl"\n', "y.idl:2:7: error: ';' stands where a name is expected", "  long;", "      ^")


class Preprocessing(SyntaxTest):
    def test_comments_need_not_be_utf_8(self):
        self.assert_reads(b"\xef\xbb\xbf// caf\xe9, it's\nstruct S { long x; /* \xff */ };\n")

    def test_names_of_the_machine_are_no_macros(self):
        self.assert_reads("struct linux { long unix; };\n")

    def test_macros_come_from_the_file_and_the_command(self):
        self.assert_reads("#define M(t) typedef t T_##t;\n#ifndef A\n!\n#endif\n#if N == 3 && defined(__SKEIN_IDL__)\nM(long)\n#else\n!\n#endif\n",
                          "A", "N=3")  # fmt: skip


class Grammar(unittest.TestCase):
    def test_the_grammar_has_no_conflicts(self):
        lark.logger.setLevel(logging.DEBUG)
        with open(f"{ROOT}/idl/compiler/front_end/grammar.lark", encoding="utf-8") as stream, self.assertLogs(lark.logger) as logs:
            lark.logger.info("begin")
            lark.Lark(stream.read(), parser="lalr", debug=True)
        self.assertEqual([line for line in logs.output if "onflict" in line], [])


unittest.main(verbosity=0)
