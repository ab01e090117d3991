"""architecture.py CHECK --root FOLDER [--compiler C --include FOLDER … --header FILE --library FILE … --build FOLDER --folder FOLDER …]

Prints each violation of a rule of ARCHITECTURE.md; the exit code is 1 where there are any, 77 where there was nothing to check.
"""

import argparse
import sys

import budget_rules
import compile_rules
import definition_rules
import include_rules
import text_rules
from source_tree import SourceTree


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("check")
    parser.add_argument("--root")
    parser.add_argument("--compiler", default="c++")
    parser.add_argument("--include", action="append", default=[])
    parser.add_argument("--header")
    parser.add_argument("--library", action="append", default=[])
    parser.add_argument("--build", default=".")
    parser.add_argument("--folder", action="append", default=[])
    arguments = parser.parse_args()
    tree = SourceTree(arguments.root)
    compiler = compile_rules.Compiler(arguments.compiler, arguments.include)
    checks = {
        "homes": lambda: include_rules.homes(tree),
        "precompiled_headers": lambda: include_rules.precompiled_headers(tree),
        "public_headers": lambda: include_rules.public_headers(tree),
        "floors": lambda: include_rules.floors(tree),
        "test_floors": lambda: include_rules.test_floors(tree),
        "machine_paths": lambda: text_rules.machine_paths(tree),
        "sleeps": lambda: text_rules.sleeps(tree),
        "quotes": lambda: text_rules.quotes(tree),
        "links": lambda: text_rules.links(tree),
        "workarounds": lambda: text_rules.workarounds(tree),
        "budget": lambda: budget_rules.budget(tree),
        "mission_lines": lambda: budget_rules.mission_lines(tree, arguments.build),
        "lone_headers": lambda: compile_rules.lone_headers(tree, compiler),
        "older_standard": lambda: compile_rules.older_standard(tree, compiler),
        "generated_version": lambda: compile_rules.generated_version(arguments.header, compiler),
        "generated_includes": lambda: compile_rules.generated_includes(arguments.header),
        "linked_vendors": lambda: compile_rules.linked_vendors(arguments.library[0]),
        "one_definition": lambda: definition_rules.one_definition(arguments.library, arguments.build, arguments.root),
        "unity_names": lambda: definition_rules.unity_names(arguments.build),
        "open_search_paths": lambda: compile_rules.open_search_paths(arguments.folder),
    }
    if arguments.check not in checks:
        parser.error(f"there is no check '{arguments.check}'; known are {', '.join(checks)}")
    if arguments.check == "quotes" and not text_rules.quoted_code(tree):
        print("skipped: neither README nor the guide quotes code")
        return 77
    violations = list(checks[arguments.check]())
    print("\n".join(violations) or f"{arguments.check}: nothing found")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
