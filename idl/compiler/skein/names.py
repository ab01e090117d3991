"""IDL identifiers as C++ ones. Whatever C++ or the generated code reserves gets a trailing underscore."""

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
MACROS = frozenset("NULL EOF errno assert stdin stdout stderr NAN INFINITY HUGE_VAL offsetof BUFSIZ".split())
NAMESPACE = KEYWORDS | MACROS | {"std", "to_string", "type_support", "key_hash", "hash_value"}
MEMBER = KEYWORDS | MACROS
EXCEPTION_MEMBER = MEMBER | {"info", "value", "what", "text", "exception_info"}
UNION_MEMBER = MEMBER | {"discriminator", "select", "tag_", "held_", "index_of"}
PARAMETER = KEYWORDS | MACROS | {"in", "out"}
OPERATION = MEMBER | {
    "Proxy", "Skeleton", "interface_info", "channel", "disconnect", "within", "dispatch", "call", "async_call",
    "set_timeout", "call_time", "ProxyBase", "kDefaultTimeout", "implementation", "TypedCall",
}  # fmt: skip


def unique(name, reserved, taken):
    """The C++ name for `name`, which joins `taken`."""
    while name in reserved or name in taken:
        name += "_"
    taken.add(name)
    return name


def plain(name, reserved=NAMESPACE):
    return name + "_" if name in reserved else name
