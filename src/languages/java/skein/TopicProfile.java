package skein;

/** What fits the data of a topic; see skein/c/skein.h. */
public enum TopicProfile {
  EVERY_VALUE,
  SENSOR,
  COMMAND,
  STATE
}
