"""Documentation: the IDL's own comments, taken from directly above a declaration."""

import bisect
import re


class Comments:
    def __init__(self, source):
        self._source = source
        self._ends = [comment.end for comment in source.comments]

    def above(self, offset):
        """The lines of text of the block of comments above what stands at `offset`; doc comments may be a blank line or two away."""
        block = []
        expected = None
        below, line = offset, self._source.place(offset).line
        for index in range(bisect.bisect_right(self._ends, offset) - 1, -1, -1):
            comment = self._source.comments[index]
            if expected is None and not 0 <= line - comment.last.line <= 3:
                break
            if self._source.text[comment.end : below].strip() or comment.behind:
                break
            below = comment.begin
            if re.match(r"//[/!]?<|/\*[*!]?<", comment.text):
                continue  # describes what stands before it
            if expected is None:
                if line - comment.last.line > (3 if comment.text.startswith(("///", "//!", "/**", "/*!")) else 1):
                    break
            elif comment.last.line != expected:
                break
            block.insert(0, comment.text)
            if not comment.text.startswith("//"):
                break
            expected = comment.first.line - 1
        # A backslash at the end would draw the next line of C++ into the comment.
        return [line.rstrip("\\") for text in block for line in _lines(text)]


    def say_key(self, offset):
        """Whether RTI's `//@key` stands on the line behind the member that ends at `offset`."""
        index = bisect.bisect_left(self._ends, offset)
        if index == len(self._ends):
            return False
        comment = self._source.comments[index]
        between = self._source.text[offset : comment.begin]
        return "\n" not in between and between.strip(" \t;") == "" and re.match(r"//@key\s*$", comment.text, re.IGNORECASE) is not None


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
