"""Documentation: the IDL's own comments, taken from directly above a declaration."""

import re


def documentation(node):
    """The lines of text of the last block of comments above `node`, which may be doc comments a line away."""
    block = []
    expected = None
    for comment in reversed(node.comments()):
        text = comment.text().rstrip("\n")
        if re.match(r"//[/!]?<|/\*[*!]?<", text):
            continue  # describes what stands before it
        last = comment.line() + text.count("\n")
        if expected is not None and last != expected:
            break
        if expected is None and not _is_near(text, last, node.line()):
            break
        block.insert(0, text)
        expected = comment.line() - 1 if text.startswith("//") else -1
        if expected == -1:
            break
    # A backslash at the end would draw the next line of C++ into the comment.
    return [line.rstrip("\\") for text in block for line in _lines(text)]


def _is_near(text, last, line):
    distance = line - last
    is_doc = text.startswith(("///", "//!", "/**", "/*!"))
    return distance <= (3 if is_doc else 1)


def _lines(text):
    if text.startswith("//"):
        return [re.sub(r"^//[/!]? ?", "", text).rstrip()]
    inner = re.sub(r"^/\*[*!]?|\*/$", "", text)
    lines = [re.sub(r"^\s*\*? ?", "", line).rstrip() for line in inner.split("\n")]
    while lines and not lines[0]:
        lines.pop(0)
    while lines and not lines[-1]:
        lines.pop()
    return lines
