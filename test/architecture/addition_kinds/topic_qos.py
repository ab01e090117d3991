"""What it takes to add a QoS that a profile may set of a topic. See peer_attribute.py."""
from additions import Edit

MOST = 4
EDITS = (
    Edit("mission_profiles/schema/mission.xsd", before='    <xs:attribute name="lease" type="TimeOrNone">\n',
         text='    <xs:attribute name="dummy" type="TimeOrNone">\n'
              '      <xs:annotation><xs:documentation>Obeyed by nobody yet; or `none`.</xs:documentation></xs:annotation>\n'
              '    </xs:attribute>\n'),
    Edit("include/skein/topic_qos.hpp", after="  std::optional<std::chrono::milliseconds> lifespan;\n",
         text="  std::optional<std::chrono::milliseconds> dummy;\n"),
    Edit("src/mission/profile/topic_rules_reader.cpp", after='  set(&TopicQos::lifespan, read_period(topic, "lifespan"));\n',
         text='  set(&TopicQos::dummy, read_period(topic, "dummy"));\n'),
)
TARGETS = ("profile_test", "profile_schema_test")
TESTS = "^(profile_test|profile_schema_test)$"
