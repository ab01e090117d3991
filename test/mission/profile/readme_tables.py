#!/usr/bin/env python3
"""The tables of attributes in mission_profiles/README.md, from mission_profiles/schema/mission.xsd, which editors show, too.
Without arguments: whether they agree. With --write, as by the target readme_tables: writes them. A table stands below a mark, `<!-- schema: NAME -->`: an element, a type
or a group of attributes. The last sentence of a text, `Default: ...`, has a column of its own."""
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[3] / "mission_profiles"
MARKED_TABLE = re.compile(r"(<!-- schema: (\w+) -->\n)(?:\|.*\n)*")
XS = "{http://www.w3.org/2001/XMLSchema}"
SCHEMA = ElementTree.parse(FOLDER / "schema/mission.xsd").getroot()


def text_of(node):
    return " ".join(node.findtext(f"{XS}annotation/{XS}documentation", "").split())


def attributes_of(owner):
    """Names with a text. A group whose reference has a text stays together."""
    for node in owner:
        if node.tag == XS + "attribute":
            text = text_of(node)
            yield [node.get("name")], text + " Default: required." if node.get("use") == "required" else text
        if node.tag == XS + "attributeGroup":
            group = list(attributes_of(SCHEMA.find(f"{node.tag}[@name='{node.get('ref')}']")))
            text = text_of(node)
            yield from [([name for names, _ in group for name in names], text)] if text else group


def table(name):
    owner = SCHEMA.find(f"*[@name='{name}']")
    inner = owner.find(XS + "complexType")
    rows = []
    for names, text in attributes_of(owner if inner is None else inner):
        meaning, _, default = text.partition(" Default: ")
        rows.append((" ".join(f"`{each}`" for each in names), meaning.removesuffix("."), default.removesuffix(".")))
    columns = 3 if any(default for *_, default in rows) else 2
    rows = [("attribute", "meaning", "default"), ("---",) * 3, *rows]
    return "".join("|" + "|".join(f" {cell} ".replace("  ", " ").replace(" --- ", "---") for cell in row[:columns]) + "|\n" for row in rows)


def main():
    readme = FOLDER / "README.md"
    old = readme.read_text(encoding="utf-8")
    new = MARKED_TABLE.sub(lambda found: found[1] + table(found[2]), old)
    if "--write" in sys.argv:
        readme.write_text(new, encoding="utf-8")
    elif new != old or "<!-- schema: " not in old:
        sys.exit(f"{readme} and its schema differ; build the target readme_tables")


if __name__ == "__main__":
    main()
