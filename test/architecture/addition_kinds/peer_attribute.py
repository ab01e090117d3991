"""What it takes to add an attribute of a peer, which its group and what refuses it at programs follow. The tables of the README are
written by the target readme_tables; the sample of the schema's test is completed from the schema."""
from additions import Edit

MOST = 4
EDITS = (
    Edit("mission_profiles/schema/mission.xsd", before='    <xs:attribute name="process_cpus" type="Cpus">\n      <xs:annotation><xs:documentation>\n        The CPUs on',
         text='    <xs:attribute name="dummy" type="Text">\n'
              '      <xs:annotation><xs:documentation>What it logs when it starts. Default: nothing.</xs:documentation></xs:annotation>\n'
              '    </xs:attribute>\n'),
    Edit("src/mission/profile/mission_profile.hpp", before="  bool runs_mission = false;  ///< Its end is the mission's, its exit code too.\n",
         text="  std::string dummy;          ///< What it logs when it starts.\n"),
    Edit("src/mission/profile/mission_reader.cpp", after='    peer.plugin = value_or(element, "plugin", "");\n',
         text='    if (element.maybe_attribute("dummy")) peer.dummy = element.attribute("dummy").value;\n'),
    Edit("src/mission/peer/peer.cpp", before="  if (csp ? csp->threads.lock_memory : peer->threads.lock_memory) lock_memory();\n",
         text='  if (!peer->dummy.empty()) log(LogLevel::Info, "launch", peer->dummy);\n'),
)
TARGETS = ("readme_tables", "profile_test", "profile_schema_test", "skein_command")
TESTS = "^(profile_test|profile_schema_test|profile_readme_tables)$"
