"""What it takes to add a topic on which entities tell of themselves."""

from additions import Edit

MOST = 4
EDITS = (
    Edit(
        "idl/skein/introspection.idl",
        before="  // Durations are in nanoseconds from here on.\n",
        text="""  /// That an entity goes on.
  struct Dummy {
    @key Identity entity;
    unsigned long long number;  ///< From 1.
  };

""",
    ),
    Edit("src/rpc/service/introspection_topic.hpp", after="struct Decision;\n", text="struct Dummy;\n"),
    Edit(
        "src/rpc/service/introspection_topic.hpp",
        before="};\n\n/// The one that carries values of that type.\n",
        text="""    Topic<Dummy>{{.name = "skein/dummy",
                         .type_name = "skein::introspection::Dummy",
                         .keyed = true,
                         .history_depth = 1,
                         .interval = std::chrono::milliseconds(500),
                         .recorded = true,
                         .viewed = true}},
""",
    ),
    Edit(
        "src/entity/entity.cpp",
        after="  tell(introspection::kTopic<introspection::LogLine>, introspection::LogReport(id()));\n",
        text="""  tell(introspection::kTopic<introspection::Dummy>,
       [entity = guid().bytes, number = std::uint64_t{}](bool) mutable {
         return std::vector<introspection::Dummy>{{entity, ++number}};
       });
""",
    ),
)
TARGETS = ("introspection_topic_test", "selection_test", "recording_test")
TESTS = "^(introspection_topic_test|selection_test|recording_test)$"
