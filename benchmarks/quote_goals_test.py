"""What benchmarks/README.md says of the goals, and how it comes there."""

import pathlib
import re
import sys
import unittest

import quote_goals

HERE = pathlib.Path(__file__).parent
MEASURED = """| goal | limit | worst | comparisons that meet it |
|---|---|---|---|
| Quick | p50 ≤ 1.00× | p50 0.50× | met (1 of 1) |
| Small | p50 ≤ 1.00× | | not measured |
| New | p50 ≤ 1.00× | | not measured |
"""


class QuoteGoals(unittest.TestCase):
    def test_what_was_measured_takes_the_place_of_what_was_before_and_nothing_else_does(self):
        before = quote_goals.HEAD + (
            "| Small | p50 ≤ 1.00× | p50 2.00× | missed (0 of 1) | 2026-01-01 |\n"
            "| Quick | p50 ≤ 1.00× | p50 9.00× | missed (0 of 1) | 2026-01-01 |\n"
            "| Gone | p50 ≤ 1.00× | p50 9.00× | missed (0 of 1) | 2026-01-01 |\n"
        )
        self.assertEqual(
            quote_goals.merged(before, MEASURED, "2026-02-02"),
            quote_goals.HEAD + "| Quick | p50 ≤ 1.00× | p50 0.50× | met (1 of 1) | 2026-02-02 |\n"
            "| Small | p50 ≤ 1.00× | p50 2.00× | missed (0 of 1) | 2026-01-01 |\n"
            "| New | p50 ≤ 1.00× |  | not measured |  |\n",
        )

    def test_the_readme_has_every_goal_in_the_goals_order(self):
        source = (HERE / "harness/goals.cpp").read_text(encoding="utf-8")
        found = re.findall(r'^      \{((?:"[^"]*"\s*)+),', source, re.MULTILINE)
        goals = ["".join(re.findall(r'"([^"]*)"', text)) for text in found]
        table = quote_goals._TABLE.search((HERE / "README.md").read_text(encoding="utf-8")).group()
        self.assertEqual(list(quote_goals.rows(table)), goals)


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    unittest.main()
