"""wrong_use_test.py SOURCE COMPILER ARGUMENTS…: the compiler finds each line of SOURCE that ends with a comment, and first says what stands there."""

import collections
import re
import subprocess
import sys

source, *command = sys.argv[1:]
output = subprocess.run([*command, "-fsyntax-only", source], text=True, capture_output=True, check=False).stderr
name = re.escape(source)
said = collections.defaultdict(str)  # by line
line = None
for row in output.splitlines():
    if place := re.search(rf"{name}:(\d+):\d+:   (?:recursively )?required from here|^{name}:(\d+):\d+: error", row):
        line = int(place.group(1) or place.group(2))
    elif row.startswith(("In file included", "In instantiation")) or ": In " in row:
        line = None
    if line and not re.match(r" *\d* \|", row):  # a quoted line of the source shows the comment itself
        said[line] += row + "\n"
with open(source, encoding="utf-8") as stream:
    wanted = {number: found.group(1) for number, text in enumerate(stream, 1) if (found := re.search(r"; *// (.+)$", text))}
first = {number: next((row for row in text.splitlines() if "error: " in row), "") for number, text in said.items()}
untold = [number for number, expected in wanted.items() if not re.search(expected, first.get(number, ""))]
unexpected = set(said) - set(wanted)
for number in untold:
    print(f"{source}:{number}: the compiler is to say first '{wanted[number]}', and says:\n{said[number]}")
for number in unexpected:
    print(f"{source}:{number}: is found, and no comment says so:\n{said[number]}")
failed = untold or unexpected
print(output if failed else f"{len(wanted)} mistakes are told as they should be")
sys.exit(1 if failed else 0)
