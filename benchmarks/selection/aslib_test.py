#!/usr/bin/python3
"""How aslib.py reads a file of attributes and rows; select_test has whole scenarios."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
import aslib  # noqa: E402

HEADER = "@ATTRIBUTE a NUMERIC\n@ATTRIBUTE b {x, y}\n@DATA\n"
REFUSED = [
    (HEADER + "1\n", ":4", "the row has 1 values"),
    (HEADER + "1,x,2\n", ":4", "the row has 3 values"),
    (HEADER + "one,x\n", ":4", "'one' is no number"),
    (HEADER + "1,z\n", ":4", "no value 'z'"),
    (HEADER + "1,\n", ":4", "a value is empty"),
    (HEADER + "1,'x\n", ":4", "a quote is not closed"),
    (HEADER + "1,'x' y\n", ":4", "text follows"),
    (HEADER + "{0 1}\n", ":4", "sparse"),
    ("@ATTRIBUTE a NUMERIC\n@ATTRIBUTE A REAL\n", ":2", "declared twice"),
    ("@ATTRIBUTE a RELATIONAL\n", ":1", "'relational' is not supported"),
    ("@ATTRIBUTE a {x, y\n", ":1", "not closed"),
    ("@ATTRIBUTE\n", ":1", "no name"),
    ("1,2\n", ":1", "no declaration"),
    ("@DATA\n", ":1", "no attribute"),
    ("@RELATION r\n", "", "has no @DATA"),
]


class Reading(unittest.TestCase):
    def table(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a.arff"
            path.write_bytes(text.encode())
            return aslib.Table(path)

    def test_a_file_is_read_in_either_case_with_comments_and_quotes(self):
        table = self.table(
            "\ufeff% a comment\r\n\n@Relation 'x y'\n@attribute 'an id' String\n"
            "@ATTRIBUTE n REAL\n@ATTRIBUTE s { ok , 'not ok' } % why\n\n@DATA\n"
            "'a, \\'b\\'',+1.5e1,ok\n% between\n \"?\" , ? , 'not ok'\n"
        )
        first, second = table.rows
        self.assertEqual(first[0], 9)
        self.assertEqual(table.text(first, "AN ID"), "a, 'b'")
        self.assertEqual(table.number(first, "n"), 15)
        self.assertEqual(table.text(second, "an id"), "?")
        self.assertIsNone(table.number(second, "n"))
        self.assertEqual(table.number(second, "s"), 1)

    def test_what_is_no_such_file_is_refused_with_its_line_the_cause_and_the_remedy(self):
        for text, line, cause in REFUSED:
            with self.subTest(text), self.assertRaises(aslib.Refused) as refused:
                self.table(text)
            for part in ("a.arff" + line, cause, "; " if line else ""):
                self.assertIn(part, str(refused.exception))
        with self.assertRaisesRegex(aslib.Refused, "/nowhere/a.arff cannot be read"):
            aslib.Table(Path("/nowhere/a.arff"))


if __name__ == "__main__":
    unittest.main()
