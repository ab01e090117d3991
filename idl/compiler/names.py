"""IDL identifiers as C++ ones. A keyword gets the prefix `_cxx_`, as in the OMG's mappings (IDL to C++11, clause 6.1.2); whatever else
the standard library or the generated code reserves, an underscore behind it."""

from macros import FAMILIES, MACROS

KEYWORDS = frozenset(
    """alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t char32_t class
    compl concept const consteval constexpr constinit const_cast continue co_await co_return co_yield decltype default
    delete do double dynamic_cast else enum explicit export extern false float for friend goto if inline int long
    mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public register
    reinterpret_cast requires return short signed sizeof static static_assert static_cast struct switch template this
    thread_local throw true try typedef typeid typename union unsigned using virtual void volatile wchar_t while xor
    xor_eq""".split()
)
# Macros of the standard library that a generated header may meet.
NAMESPACE = MACROS | {"std", "to_string", "type_support", "key_hash", "hash_value"}
MEMBER = MACROS
EXCEPTION_MEMBER = MEMBER | {"info", "value", "what", "text", "exception_info"}
UNION_MEMBER = MEMBER | {"discriminator", "select", "tag_", "held_", "index_of"}
PARAMETER = MACROS | {"in", "out"}
OPERATION = MEMBER | {
    "Proxy", "Skeleton", "Deferred", "answers_later", "interface_info", "channel", "disconnect", "within", "dispatch", "call", "async_call",
    "set_timeout", "call_time", "ProxyBase", "kDefaultTimeout", "implementation", "TypedCall", "type_support",
}  # fmt: skip


def unique(name, reserved, taken):
    """The C++ name for `name`, which joins `taken`."""
    name = _no_keyword(name)
    while name in reserved or name in taken:
        name += "_"
    taken.add(name)
    return name


def plain(name, reserved=NAMESPACE):
    name = _no_keyword(name)
    return name + "_" if name in reserved else name


def _no_keyword(name):
    return "_cxx_" + name if name in KEYWORDS else name + "_" if FAMILIES.fullmatch(name) else name
