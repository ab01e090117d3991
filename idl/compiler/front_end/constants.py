"""Constant expressions (OMG IDL 4.2, clause 7.4.1.4.3), in exact integers: what counts is whether the result fits."""

import re
import struct

import lark

import model

from .scopes import Enumerator, Flag


class Fault(Exception):
    """What is wrong, and the tree or token where."""

    def __init__(self, where, reason):
        super().__init__(reason)
        self.where = where
        self.reason = reason


class Text(str):
    """The bytes of a string in UTF-8, each as a character."""


class WideText(str):
    pass


class Character(str):
    """One byte."""


class WideCharacter(str):
    pass


_RANGES = {
    "octet": (0, 255),
    "int8": (-128, 127),
    "short": (-(1 << 15), (1 << 15) - 1),
    "unsigned short": (0, (1 << 16) - 1),
    "long": (-(1 << 31), (1 << 31) - 1),
    "unsigned long": (0, (1 << 32) - 1),
    "long long": (-(1 << 63), (1 << 63) - 1),
    "unsigned long long": (0, (1 << 64) - 1),
}
_MOST_DIGITS = 40  # of a whole number; 2^64 has 22 in octal
_WIDEST = 1 << 12  # bits of an intermediate result
_ESCAPES = {"n": "\n", "t": "\t", "v": "\v", "b": "\b", "r": "\r", "f": "\f", "a": "\a"}
_ESCAPE = re.compile(r"\\(u[0-9a-fA-F]{1,4}|x[0-9a-fA-F]{1,2}|[0-7]{1,3}|[ntvbrfa\\?'\"]|(?P<other>.))", re.DOTALL)


def integers(kind):
    """The least and the greatest value of an integer type; None for any other."""
    kind = model.unaliased(kind)
    return _RANGES.get(kind.idl) if isinstance(kind, model.Primitive) else None


def value(tree, kind, resolve):
    """The value of an expression as a constant of type `kind`: an int, a float, a bool, text, or the name of an enumerator. `resolve`
    gives what a scoped name stands for. Raises Fault."""
    kind = model.unaliased(kind)
    return _fitted(tree, _evaluated(tree, resolve, kind), kind)


def size(tree, resolve):
    """The value of an expression as a bound or a size: from 1 to 2^31 - 1."""
    found = _evaluated(tree, resolve, model.Primitive("unsigned long"))
    if isinstance(found, bool) or not isinstance(found, int):
        raise Fault(tree, "a size is a whole number")
    if not 0 < found < 1 << 31:
        raise Fault(tree, f"{found} is no size: it is at least 1 and at most 2147483647")
    return found


def _fitted(tree, found, kind):
    if isinstance(kind, model.Named) and isinstance(kind.decl, model.Bitmask):
        return _fitted(tree, found, model.Primitive(model.UNSIGNED[kind.decl.bits]))
    if isinstance(kind, model.Primitive):
        found = _converted(found, kind.idl)
    if isinstance(kind, model.Named):
        if isinstance(found, Enumerator) and found.enum is kind.decl:
            return found.name
        raise Fault(tree, f"an enumerator of {kind.decl.idl_name} is expected here")
    if isinstance(kind, (model.String, model.WideString)):
        return _fitted_text(tree, found, kind)
    if not isinstance(kind, model.Primitive):
        raise Fault(tree, "a constant is a number, a character, text, a boolean or an enumerator")
    if kind.idl in _RANGES:
        least, greatest = _RANGES[kind.idl]
        if isinstance(found, bool) or not isinstance(found, int):
            raise Fault(tree, f"a whole number is expected here, for {kind.idl}")
        if not least <= found <= greatest:
            raise Fault(tree, f"{found} does not fit into {kind.idl}, which goes from {least} to {greatest}")
        return found
    if kind.idl in ("float", "double", "long double"):
        return _fitted_number(tree, found, kind.idl)
    expected = {"boolean": (bool, "TRUE or FALSE"), "char": (Character, "a character"), "wchar": (WideCharacter, "a wide character")}
    wanted, spoken = expected[kind.idl]
    if not isinstance(found, wanted):
        raise Fault(tree, f"{spoken} is expected here, for {kind.idl}")
    return found


def _converted(found, idl):
    """What other compilers take, too: the number of a character, an enumerator or a boolean, and a character for a wide one."""
    is_number = isinstance(found, int) and not isinstance(found, bool)
    if idl in _RANGES and isinstance(found, Enumerator):
        return found.enum.values[[name for name, _, _ in found.enum.enumerators].index(found.name)]
    if idl == "boolean" and is_number and found in (0, 1):
        return found == 1
    if idl == "char" and is_number and 0 <= found <= 0xFF:
        return Character(chr(found))
    if idl == "wchar" and (isinstance(found, Character) or (is_number and 0 <= found <= 0xFFFF)):
        return WideCharacter(found if isinstance(found, Character) else chr(found))
    return found


def _fitted_text(tree, found, kind):
    wide = isinstance(kind, model.WideString)
    if not isinstance(found, WideText if wide else Text):
        raise Fault(tree, "wide text (L before it) is expected here" if wide else "text is expected here")
    if kind.bound and len(found) > kind.bound:
        raise Fault(tree, f"the text has {len(found)} {'characters' if wide else 'bytes'}, and {kind.bound} are allowed")
    return found


def _fitted_number(tree, found, idl):
    if isinstance(found, bool) or not isinstance(found, (int, float)):
        raise Fault(tree, f"a number is expected here, for {idl}")
    try:
        number = float(found)
    except OverflowError:
        number = float("inf")
    try:
        struct.pack("<f" if idl == "float" else "<d", number)  # rounds, as C++ does
    except OverflowError:
        number = float("inf")
    if number in (float("inf"), float("-inf")):
        least = ", of which this compiler knows double's range" if idl == "long double" else ""
        raise Fault(tree, f"the number does not fit into {idl}{least}")
    return number


# ---- evaluation


def _evaluated(tree, resolve, kind):
    def below(index):
        return _evaluated(tree.children[index], resolve, kind)

    name = tree.data
    if name in ("relative_name", "absolute_name"):
        return _named(tree, resolve(tree))
    if name in _LITERALS:
        return _LITERALS[name](tree)
    if len(tree.children) == 1:
        return _unary(tree, below(0), kind)
    return _binary(tree, below(0), below(-1))


def _named(tree, what):
    if isinstance(what, Enumerator):
        return what
    if isinstance(what, bool):
        return what
    if isinstance(what, Flag):
        return what.value
    if not isinstance(what, model.Constant):
        raise Fault(tree, f"'{what.idl_name}' is no constant")
    kind = model.unaliased(what.type)
    if isinstance(kind, model.Named) and isinstance(kind.decl, model.Enum):
        return Enumerator(what.value, kind.decl)
    if isinstance(kind, model.Named):
        return what.value
    if isinstance(kind, (model.String, model.WideString)):
        return (Text if isinstance(kind, model.String) else WideText)(what.value)
    wrapped = {"char": Character, "wchar": WideCharacter}.get(kind.idl)
    return wrapped(what.value) if wrapped else what.value


def _unary(tree, operand, kind):
    if isinstance(operand, bool) or not isinstance(operand, (int, float)):
        raise Fault(tree, "a number is expected here")
    if tree.data == "positive":
        return operand
    if tree.data == "negative":
        return -operand
    if isinstance(operand, float):
        raise Fault(tree, "'~' needs a whole number")
    least, greatest = integers(kind) or (-1, 0)
    return ~operand if least < 0 else greatest - operand


def _binary(tree, left, right):
    for operand in (left, right):
        if isinstance(operand, bool) or not isinstance(operand, (int, float)):
            raise Fault(tree, "both sides of an operator are numbers")
    whole = isinstance(left, int) and isinstance(right, int)
    operate = (_WHOLE if whole else _REAL).get(tree.data)
    if operate is None:
        raise Fault(tree, "this operator needs whole numbers")
    if tree.data in ("divide", "modulo") and right == 0:
        raise Fault(tree.children[-1], "division by zero")
    if tree.data in ("shift_left", "shift_right") and not 0 <= right < 64:
        raise Fault(tree.children[-1], f"a shift goes by 0 to 63, not by {right}")
    try:
        found = operate(left, right)
    except OverflowError:
        raise Fault(tree, "the number is too large") from None
    if isinstance(found, int) and found.bit_length() > _WIDEST:
        raise Fault(tree, "the number is too large")
    return found


def _quotient(left, right):
    """Towards zero, as in C."""
    return abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)


_REAL = {
    "add": lambda left, right: left + right,
    "subtract": lambda left, right: left - right,
    "multiply": lambda left, right: left * right,
    "divide": lambda left, right: left / right,
}
_WHOLE = {
    **_REAL,
    "divide": _quotient,
    "modulo": lambda left, right: left - right * _quotient(left, right),
    "or": lambda left, right: left | right,
    "xor": lambda left, right: left ^ right,
    "and": lambda left, right: left & right,
    "shift_left": lambda left, right: left << right,
    "shift_right": lambda left, right: left >> right,
}


# ---- literals


def _integer(tree):
    digits = tree.children[0]
    if len(digits) > _MOST_DIGITS:
        raise Fault(tree, "the number is too large")
    if digits[:2] in ("0x", "0X"):
        return int(digits, 16)
    if digits[0] != "0" or digits == "0":
        return int(digits)
    if re.search("[89]", digits):
        raise Fault(tree, f"'{digits}' begins with 0 and so is octal, which has no 8 and no 9")
    return int(digits, 8)


def written_text(tree):
    """The text of a comment: an unknown escape stands for its character."""
    return "".join(_unescaped(None, token[1:-1].encode().decode("latin-1"), wide=False) for token in tree.children)


def _unescaped(tree, text, wide):
    """`tree`: where a wrong escape is; None where none is wrong."""

    def replaced(match):
        escape = match[1]
        if tree is None and (match["other"] or escape[0] == "u"):
            return escape
        if match["other"]:
            raise Fault(tree, f"there is no escape '\\{escape}'; a backslash itself is '\\\\'")
        if escape[0] == "u" and not wide:
            raise Fault(tree, "'\\u' belongs to wide text: write L before it")
        if escape[0] in "ux":
            return chr(int(escape[1:], 16))
        if escape[0] in "01234567":
            if int(escape, 8) > 0xFF and tree is not None:
                raise Fault(tree, f"'\\{escape}' is no byte: the greatest is '\\377'")
            return chr(int(escape, 8) & 0xFF)
        return _ESCAPES.get(escape, escape)

    return _ESCAPE.sub(replaced, text)


def _text(tree):
    """Escapes name bytes; what is written out is UTF-8."""
    joined = ""
    for token in tree.children:
        joined += _unescaped(tree, token[1:-1].encode().decode("latin-1"), wide=False)
    if "\0" in joined:
        raise Fault(tree, "text cannot hold a zero byte: it would end there")
    return Text(joined)


def _wide_text(tree):
    joined = "".join(_unescaped(tree, token[2:-1], wide=True) for token in tree.children)
    if "\0" in joined:
        raise Fault(tree, "text cannot hold a zero: it would end there")
    return WideText(joined)


def _character(tree):
    found = _unescaped(tree, tree.children[0][1:-1], wide=False)
    if len(found) != 1 or ord(found) > 0xFF:
        raise Fault(tree, f"{tree.children[0]} is no character of one byte; use wchar, or text")
    return Character(found)


def _wide_character(tree):
    found = _unescaped(tree, tree.children[0][2:-1], wide=True)
    if len(found) != 1 or ord(found) > 0xFFFF:
        raise Fault(tree, f"{tree.children[0]} is no character of two bytes; use wide text")
    return WideCharacter(found)


def _fixed(tree):
    raise Fault(tree, "fixed is not supported: DDS has no such type; use double, or long long with a documented unit")


_LITERALS = {
    "integer": _integer,
    "floating": lambda tree: float(tree.children[0]),
    "fixed_literal": _fixed,
    "character": _character,
    "wide_character": _wide_character,
    "text": _text,
    "wide_text": _wide_text,
    "true": lambda tree: True,
    "false": lambda tree: False,
}


def first_token(where):
    """The token with which a tree begins; None for an empty one."""
    if isinstance(where, lark.Token) or where is None:
        return where
    return next((token for child in where.children if (token := first_token(child))), None)
