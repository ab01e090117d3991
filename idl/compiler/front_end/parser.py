"""The grammar's parser: from a source's text to a tree, with all errors of syntax."""

import hashlib
import os
import re
import sys

import lark

import model
from report import native, suggestion

_GRAMMAR = os.path.join(os.path.dirname(os.path.abspath(__file__)), "grammar.lark")
_MOST_ERRORS = 20
# Of the core data types (7.4.1), and what has always been reserved.
KEYWORDS = frozenset(
    """any boolean case char const default double enum FALSE float long module native octet sequence short string struct switch TRUE typedef
    union unsigned void wchar wstring""".split()
)
_TEMPLATES = [*model.TEMPLATES, "bitfield"]
_NAMES = {"IDENTIFIER": "a name", "INTEGER": "a number", "STRING": "text", "SEMICOLON": "';'", "LBRACE": "'{'", "RBRACE": "'}'",
          "LPAR": "'('", "RPAR": "')'", "LESSTHAN": "'<'", "MORETHAN": "'>'", "COMMA": "','", "COLON": "':'", "EQUAL": "'='",
          "LSQB": "'['", "RSQB": "']'", "__COLON_0": "'::'", "$END": "the end of the file"}  # fmt: skip


def parse(source, report):
    """The tree of what could be read; after an error the declaration in which it stands is passed over."""
    text = source.text
    if language := _other_language(text):
        report.error(source.place(_first(text)), f"this is no IDL: it looks like {language}")
        return None
    for _ in range(_MOST_ERRORS):
        try:
            tree = _parser().parse(text)
            _check_names(tree, source, report)
            return tree
        except lark.UnexpectedInput as error:
            offset = min(_offset(error, text), len(text))
            where = source.place(_solid(text, offset))
            report.error(where, _reason(error, source, text, offset))
            if not text[offset:].strip():
                return None
            begin, end = _declaration(text, offset)
            text = text[:begin] + re.sub(r"[^\n]", " ", text[begin:end]) + text[end:]
    report.error(where, f"these were {_MOST_ERRORS} errors of syntax; what follows was not read")
    return None


def _check_names(tree, source, report):
    """A keyword is no name, but for the parameters of annotations, as in ROS 2's `@value(default = …)`."""
    for around in tree.iter_subtrees():
        for token in around.children if around.data != "argument" else ():
            if getattr(token, "type", "") == "IDENTIFIER" and token in KEYWORDS:
                report.error(source.place(token.start_pos), _misused(token, around))


def _misused(keyword, around):
    """Why a keyword cannot stand there."""
    words = [str(child) for child in around.children]
    if around.data in ("relative_name", "absolute_name") and words[0] == "std":
        return f"'{keyword}' is a keyword of IDL and no name; write '{keyword}' without 'std::'"
    if keyword == "void" and around.data in ("relative_name", "absolute_name"):
        return "'void' is a keyword of IDL and no type of a member or a parameter: an operation alone may return nothing; write the type"
    return f"'{keyword}' is a keyword of IDL and no name; write '_{keyword}', which is the name '{keyword}'"


def _offset(error, text):
    if isinstance(error, lark.UnexpectedToken) and error.token.type == "$END":
        return len(text.rstrip())
    return error.pos_in_stream


def _solid(text, offset):
    """The last character that is no blank, where the text ends too early."""
    return max(len(text[:offset].rstrip()) - 1, 0) if not text[offset:].strip() else offset


def _reason(error, source, text, offset):
    if isinstance(error, lark.UnexpectedCharacters):
        if text[offset] == '"':
            return "this text does not end on its line; add the '\"' (texts that follow each other are joined)"
        if text[offset] == "#":
            return "'#' begins a directive at the beginning of a line; a comment begins with '//' in IDL"
        if text[offset] > "\x7f" and text[offset].isalpha():
            name = re.search(r"\w*$", text[:offset])[0] + re.match(r"\w+", text[offset:])[0]
            return f"a name in IDL has the letters A to Z, digits and '_'; '{name}' has '{text[offset]}'"
        if text[offset] == "'":
            return "a character in quotes is one character; text stands in double quotes"
        return f"the character '{text[offset]}' has no meaning here"
    if error.token.type == "$END" and (opened := _opening(text, len(text))) < len(text):
        return f"the file ends, but the '{{' of line {source.place(opened).line} is open; add the '}};'"
    if own := native(error.token):
        members = "; this file has no struct: IDL declares members as struct NAME { double x; };" if "{" not in text else ""
        return f"IDL has no '{error.token}'; write {own}{members}"
    found = "the file ends" if error.token.type == "$END" else f"'{error.token}' stands"
    before = re.search(r"(\w+)\s*$", text[:offset])
    if said := _misplaced(str(error.token), text[:offset], text[offset:]):
        return said
    if error.token == "<" and before and (own := _template(before[1], text[offset:])):
        return f"IDL has no '{before[1]}<'; write {own}"
    if error.token == "<" and before and before[1] == "bitfield":
        return "bit fields stand in a bitset: bitset NAME { bitfield<3> a; };"
    if error.token == "<" and before:
        found += f" behind '{before[1]}'{suggestion(before[1], _TEMPLATES)}"
    accepted = set(error.accepts or error.expected) - {"ANNOTATION", "AT_ANNOTATION"}
    expected = [name for key, name in _NAMES.items() if key in accepted]
    if expected and len(expected) == len(accepted):
        return f"{found} where {' or '.join(expected)} is expected"
    return f"{found} where a declaration or a type is expected" if "IDENTIFIER" in accepted else f"{found} where it cannot"


_CPP_WORDS = {"class": "write struct NAME { ... }; for data, interface NAME { ... }; for operations", "namespace": "write module NAME { ... };",
              "template": "write out the type for each of its arguments", "using": "write typedef TYPE NAME;"}  # fmt: skip
_KEPT = r"(?P<kept>(?:(?:in|out|inout|readonly|attribute|typedef)\s+)*)(?:const\s+)?"  # in front of a type


def _c_like(token, before, behind):
    """What C, C++ or ROS 2 write otherwise; `before` begins with what is being declared."""
    if token in _CPP_WORDS and not before.strip():
        return f"IDL has no '{token}'; {_CPP_WORDS[token]}"
    if re.search(r"\bconst\s+[\w:]+(<[^>]*>)?\s+$", before):
        return "a member or a parameter has no 'const' in IDL; leave it out: what is passed 'in' cannot change"
    if re.fullmatch(r"\s*enum\s+class\s+", before):
        return "IDL has no 'enum class'; leave 'class' out: in C++ it becomes one"
    if token in ("[", "&", "*") and (known := re.fullmatch(rf"\s*{_KEPT}(?P<type>[\w:]+(?: long| short| double)?(?:<.*>)?)\s*", before)):
        kind = _own(known["type"])
        name = re.match(r"[&*\s]*(\[[^\]]*\])?\s*(\w*)", behind)
        if token != "[":
            return f"IDL has no references and no pointers; write {known['kept']}{kind} {name[2] or 'NAME'}"
        size = (name[1] or "[]")[1:-1].strip()
        if size.isalnum():
            return f"the size of an array stands behind its name; write {kind} {name[2] or 'NAME'}[{size}]"
        return f"an array has a size; for any number of elements write {known['kept']}sequence<{kind}> {name[2] or 'NAME'}"
    if token == "]" and (known := re.fullmatch(rf"\s*{_KEPT}(?P<type>[\w:]+(?: long| short| double)?(?:<.*>)?)\s+(?P<name>\w+)\s*\[\s*", before)):
        return f"an array has a size; for any number of elements write {known['kept']}sequence<{_own(known['type'])}> {known['name']}"
    return ""


def _own(kind):
    """IDL's word for a type of another language."""
    own = native(kind)
    return own.split("'")[1] if own else kind


def _misplaced(token, before, behind):
    """What is said in IDL by other means; empty for what is not known."""
    declared = re.split(r"[;{}()]", before)[-1]  # what is being declared, as far as it was read
    if said := _c_like(token, declared.rsplit(",", 1)[-1] if "<" not in declared else declared, behind):
        return said
    block = re.search(r"\b(interface|struct|exception|union)\b[^;{}]*$", before[: _opening(before, len(before))])
    within = block[1] if block else ""
    if token == "=" and re.match(r"\s*(in|out|inout)\s", declared):
        return f"a parameter has no default in IDL; leave '{re.match(r'=[^;,)]*', behind)[0].strip()}' out"
    if token == ";" and within == "interface" and (field := re.fullmatch(r"\s*(\w[\w:<>, ]*?)\s+(\w+)\s*", declared)):
        return f"an interface has operations and attributes; write {field[1]} {field[2]}(); or attribute {field[1]} {field[2]};"
    if token == "(" and within in ("struct", "exception") and re.fullmatch(r"\s*\w[\w:<>, ]*?\s+\w+\s*", declared):
        return "members are data; operations stand in an interface"
    if token == "const" and before.rstrip().endswith(")"):
        return "IDL has no const operations; leave 'const' out"
    if not declared.strip() and re.match(r"[\w:<>]+\s+\w+\s*\(", behind):
        return "operations stand in an interface: interface NAME { ... };"
    if token == "=" and (member := re.fullmatch(r"\s*(?!const\b)([\w:<>, ]+?)\s+(\w+)\s*", declared)):
        value = re.match(r"=\s*([^;,{}]*)", behind)[1].strip() or "VALUE"
        return f"a member has no value in IDL; its default is told by @default({value}) {member[1]} {member[2]};"
    if re.match(r"\s*async\s", declared):
        return "IDL has no 'async'; leave it out: every operation can also be called asynchronously, by async_NAME in C++"
    return ""


# Files that other compilers read: how they begin.
_OTHER_LANGUAGES = {
    r"syntax\s*=|message\s+\w+\s*\{|package\s+[\w.]+\s*;": "Protocol Buffers",
    r"<[?\w!]": "XML",
    r"[\[{]\s*[\"{\[]": "JSON",
    r"(class|namespace|template|using)\b": "C++; IDL declares data by struct NAME { ... };, operations by interface NAME { ... };",
}
# Lines of a type and a name; IDL has a semicolon or a brace somewhere.
_ROS_LINE = r"(?!(module|struct|union|enum|interface|exception|typedef|const|bitset|bitmask|native)\b)[\w/]+(\[[<=\d]*\])?[ \t]+\w+[^\n]*\n|---"


def _other_language(text):
    """Which other language the text is in, by how it begins; empty where it may be IDL."""
    text = text[_first(text) :]
    if not re.search("[;{}]", text) and re.match(_ROS_LINE, text):
        return "a message, a service or an action of ROS 2; IDL declares struct NAME { double x; };"
    return next((language for begin, language in _OTHER_LANGUAGES.items() if re.match(begin, text)), "")


def _first(text):
    """Where the first token begins."""
    return len(text) - len(text.lstrip())


def _template(name, text):
    """What to write in place of a template of C++ whose '<' begins `text`; empty for other names."""
    inner = (re.match(r"<\s*([\w:, ]*?)\s*>", text) or ["", "TYPE"])[1]
    element, _, size = inner.partition(",")
    templates = {"vector": f"'sequence<{inner}>'", "list": f"'sequence<{inner}>'", "optional": f"'@optional {inner}'",
                 "array": f"'{element} NAME[{size.strip() or 'SIZE'}]'", "shared_ptr": f"'@external {inner}'"}  # fmt: skip
    return templates.get(name, "")


def _declaration(text, offset):
    """What surrounds the error: from behind the last `;`, `{` or `}` to the next `;` on the same level, at least one character. Where
    a block ends too early, the declaration whose block it is."""
    if text[offset] == "}":
        offset = _opening(text, offset)
    begin = max(text.rfind(mark, 0, offset) for mark in ";{}") + 1
    depth = 0
    for index in range(offset, len(text)):
        if text[index] == "{":
            depth += 1
        elif text[index] == "}":
            if depth == 0:
                return begin, max(index, offset + 1)
            depth -= 1
        elif text[index] == ";" and depth == 0:
            return begin, index + 1
    return begin, len(text)


def _opening(text, offset):
    """Where the block begins that ends at `offset`; `offset` itself where none does."""
    depth = 0
    for index in range(offset - 1, -1, -1):
        if text[index] == "}":
            depth += 1
        elif text[index] == "{":
            if depth == 0:
                return index
            depth -= 1
    return offset


_cached = None


def _parser():
    global _cached
    _cached = _cached or _load()
    return _cached


class _NameBeforeKeyword:
    """Lets the lexer read a name wherever a name is longest: otherwise `interfaces` would be the keyword `interface` and an `s` where
    the grammar has no name."""

    always_accept = ("IDENTIFIER",)

    @staticmethod
    def process(tokens):
        return tokens


def _load():
    """The grammar's tables, from the user's own cache where they are there."""
    folder = os.path.join(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "skein")
    with open(_GRAMMAR, encoding="utf-8") as stream:
        grammar = stream.read()
    options = {"parser": "lalr", "propagate_positions": True, "maybe_placeholders": True, "postlex": _NameBeforeKeyword()}
    try:
        os.makedirs(folder, exist_ok=True)
        key = hashlib.sha256(f"{grammar} {lark.__version__} {sys.version}".encode()).hexdigest()[:16]
        return lark.Lark(grammar, cache=os.path.join(folder, f"idl-grammar-{key}"), **options)
    except OSError:  # a cache that cannot be written costs time alone
        return lark.Lark(grammar, **options)
