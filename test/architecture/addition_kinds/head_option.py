"""What it takes to add an option of a peer's Head to the profile. See peer_attribute.py."""
from additions import Edit

MOST = 4
EDITS = (
    Edit("mission_profiles/schema/mission.xsd", before='    <xs:attribute name="max_stuck" type="Count">\n',
         text='    <xs:attribute name="dummy" type="Count">\n'
              '      <xs:annotation><xs:documentation>So many more than `max_stuck`. Default: 0.</xs:documentation></xs:annotation>\n'
              '    </xs:attribute>\n'),
    Edit("include/skein/entity.hpp", after="  std::size_t max_stuck = 3;\n",
         text="  /// So many more than `max_stuck`.\n  std::size_t dummy = 0;\n"),
    Edit("src/mission/profile/head_reader.cpp", before="  head.breaker = read_breaker(element);\n",
         text='  head.dummy = static_cast<std::size_t>(read_count(element, "dummy", 0));\n'),
    Edit("src/entity/head/head.cpp", after="bool Head::degraded() const { return state_->overdue.count() >= state_->options.max_stuck",
         text=" + state_->options.dummy"),
)
TARGETS = ("readme_tables", "profile_test", "profile_schema_test")
TESTS = "^(profile_test|profile_schema_test|profile_readme_tables)$"
