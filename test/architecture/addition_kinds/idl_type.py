"""What it takes to add an IDL type template in C++, its description, dynamic types and JSON: `pair<A, B>`, one value of each type."""

from additions import Edit

MOST = 12

_CDR = """template <class First, class Second>
void encode(CdrWriter& writer, const std::pair<First, Second>& value) {
  encode(writer, value.first);
  encode(writer, value.second);
}
template <class First, class Second>
void decode(CdrReader& reader, std::pair<First, Second>& value) {
  decode(reader, value.first);
  decode(reader, value.second);
}

"""
_JSON = """template <class First, class Second>
void write_json(JsonWriter& writer, const std::pair<First, Second>& value) {
  writer.begin_object();
  writer.key("first");
  write_json(writer, value.first);
  writer.key("second");
  write_json(writer, value.second);
  writer.end_object();
}
template <class First, class Second>
void read_json(const JsonReader& reader, std::pair<First, Second>& value) {
  static constexpr std::string_view members[] = {"first", "second"};
  reader.expect_members("a pair", members);
  read_json(reader.member("first"), value.first);
  read_json(reader.member("second"), value.second);
}

"""

EDITS = (
    Edit(
        "idl/compiler/front_end/grammar.lark",
        after='  | "map" "<" element "," element ["," bound] ">" -> map\n',
        text='  | "pair" "<" element "," element ">" -> pair\n',
    ),
    Edit(
        "idl/compiler/model.py",
        before="@dataclass(frozen=True)\nclass Named(Kind):\n",
        text="@dataclass(frozen=True)\nclass Pair(Kind):\n    first: Kind\n    second: Kind\n"
        '    keyword, cpp, described, holds_all = "pair", "std::pair<{}, {}>", 22, True\n\n\n',
    ),
    Edit("idl/skein/types.idl", after="    Reference", text=",\n    Pair"),
    Edit("include/skein/detail/codec.hpp", before="template <class T>\nvoid encode(CdrWriter& writer, const Box<T>& value) {\n", text=_CDR),
    Edit("include/skein/detail/json_codec.hpp", before="template <class T>\nvoid write_json(JsonWriter& writer, const Box<T>& value) {\n", text=_JSON),
    Edit(
        "src/idl/types/template_kinds.hpp",
        after='    {types::Kind::OptionalMember, "", 1},\n',
        text='    {types::Kind::Pair, "pair", 2, true, "a pair", {"first", "second"}},\n',
    ),
    Edit(
        "idl/README.md",
        after="a key is a number, a character, text, a boolean or an enumeration |\n",
        text="| `pair<A, B>` | `std::pair<A, B>` |\n",
    ),
    Edit(  # a sequence, since zero need not be an enumeration's first value, of which std::pair knows nothing
        "test/idl/random_idl.py",
        before="        return dice.choice(simple)\n",
        text='        if depth < 3 and dice.random() < 0.2:\n'
        '            return f"pair<{dice.choice([\'long\', \'string<3>\', \'wchar\'])}, sequence<{self.type(depth + 1)}>>"\n',
    ),
    Edit(
        "test/idl/beyond_idlc.idl",
        after="  struct Crowd { sequence<Wide> wide; };\n",
        text="  @appendable struct Pairs {\n    pair<string<3>, sequence<long, 2>> one;\n    map<long, pair<char, Wide>> more;\n"
        "    pair<long, pair<octet, double>> last[2];\n  };\n",
    ),
    Edit(
        "test/idl/syntax_test.py",
        after='            "typedef map<string, sequence<int8>> M; typedef map<uint64, int16, 10> N;\\n"\n',
        text='            "typedef pair<string, sequence<int8>> P;\\n"\n',
    ),
)

TARGETS = ("skein", "idl_test")
TESTS = "^(idl_syntax_test|idl_compiler_test|idl_fuzz_test|idl_verdict_test|idl_foreign_test|idl_describe_test|idl_test)$"
