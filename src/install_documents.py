"""install_documents.py SOURCE TARGET FILE...: copies documents so that they can be read without the source tree.

A relative link to something that is not among the files becomes plain text.
"""

import os
import pathlib
import re
import sys

_LINK = re.compile(r"!?\[([^\[\]]*)\]\(([^()\s#]+)(#[^()\s]*)?\)")


def without_dead_links(path, text, there):
    """The text of a document whose links lead to `there` or to web pages alone."""

    def live(link):
        target = link.group(2)
        if re.match(r"[a-z]+:", target):
            return link.group()
        return link.group() if os.path.normpath(os.path.join(os.path.dirname(path), target)) in there else link.group(1)

    return _LINK.sub(live, text)


def main(source, target, *paths):
    there = set(paths)
    for path in paths:
        there |= {str(folder) for folder in pathlib.PurePosixPath(path).parents}
    for path in paths:
        content = (pathlib.Path(source) / path).read_bytes()
        if path.endswith(".md"):
            content = without_dead_links(path, content.decode("utf-8"), there).encode("utf-8")
        new = pathlib.Path(target) / path
        new.parent.mkdir(parents=True, exist_ok=True)
        new.write_bytes(content)


if __name__ == "__main__":
    main(*sys.argv[1:])
