/* Skein for C, and for every language that can call C. C99.
 *
 * There are three shapes only.
 *  - Handles: small structs, passed by value, which name an object. 0 names none. A handle that was
 *    never made, was freed before, or names an object of another kind is an error of the class
 *    SKEIN_INVALID_ARGUMENT with a sentence; never undefined behaviour, whichever thread uses it.
 * An object that a running function uses lives until that function returns.
 *  - Values: structs without ownership. Pointers in arguments are read during the call alone. Of
 *    pointers that a function or a callback gives, it says how long they hold.
 *  - Callbacks: a struct of functions with a `user` pointer, which every one of them gets.
 *    `on_close` may be NULL; it is called once, after the last of the others has returned and when
 *    none will follow, if the function that took the callbacks returned true, and otherwise never.
 *    Callbacks run on Skein's threads. None runs under a lock of Skein's, so each may call Skein.
 *    What they throw (C++) ends the process.
 *
 * Errors. A function returns whether it has succeeded; results come by pointers (`out`, `value`,
 * …), which are written on success alone, and may not be NULL unless that is said. The last
 * argument is where an error goes: skein_error_new() makes one for each thread that calls; 0
 * ignores errors.
 *
 * Times are nanoseconds (`_ns`). Texts are UTF-8 and end with a zero. All functions are
 * thread-safe.
 */
#ifndef SKEIN_C_SKEIN_H
#define SKEIN_C_SKEIN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SKEIN_MILLISECOND INT64_C(1000000)
#define SKEIN_SECOND INT64_C(1000000000)

/* ---- handles ---- */

typedef struct skein_error {
  uint64_t id;
} skein_error;
typedef struct skein_result {
  uint64_t id;
} skein_result;
typedef struct skein_entity {
  uint64_t id;
} skein_entity;
typedef struct skein_interface {
  uint64_t id;
} skein_interface;
typedef struct skein_proxy {
  uint64_t id;
} skein_proxy;
typedef struct skein_call {
  uint64_t id;
} skein_call;
typedef struct skein_stream {
  uint64_t id;
} skein_stream;
typedef struct skein_provider {
  uint64_t id;
} skein_provider;
typedef struct skein_reply {
  uint64_t id;
} skein_reply;
typedef struct skein_publisher {
  uint64_t id;
} skein_publisher;
typedef struct skein_subscription {
  uint64_t id;
} skein_subscription;

/* ---- errors ---- */

/* Classes of failure, by what the caller can do next. */
typedef int32_t skein_error_kind;
enum {
  SKEIN_OK = 0,
  SKEIN_UNAVAILABLE = 1,      /* Not executed: no provider is available. Try later or elsewhere. */
  SKEIN_OVERLOADED = 2,       /* Not executed: a queue is full. Back off, then try again. */
  SKEIN_DISCONNECTED = 3,     /* The provider died or left; whether the call ran is unknown. */
  SKEIN_TIMED_OUT = 4,        /* The deadline passed; whether the call ran is unknown. */
  SKEIN_CANCELLED = 5,        /* The caller gave up; whether the call ran is unknown. */
  SKEIN_UNIMPLEMENTED = 6,    /* The provider does not know the operation or this version of it. */
  SKEIN_INVALID_ARGUMENT = 7, /* The input is invalid; the same input will fail again. */
  SKEIN_INTERNAL = 8,         /* A failure that the interface does not declare. */
  SKEIN_DECLARED = 9 /* An exception that the interface declares: skein_error_exception(). */
};

/* How a value is written. */
typedef int32_t skein_encoding;
enum {
  SKEIN_JSON = 0,  /* Text; values that Skein gives end with a zero behind their size. */
  SKEIN_CDR = 1,   /* XCDR1 or XCDR2 with its encapsulation header, of either byte order. */
  SKEIN_STRUCT = 2 /* The C struct that the IDL compiler declares, by its address and sizeof. */
};

/* A value of an IDL type. Arguments of a call are a struct of its in and inout parameters, a result
 * one of `return_`, if there is one, and its out and inout parameters, in this order. In JSON that
 * is an object; a single argument may be given alone. NULL and 0: no arguments, or no result. */
typedef struct skein_value {
  const void* data;
  size_t size;
  skein_encoding encoding;
} skein_value;

static inline skein_value skein_json(const char* text) {
  skein_value value = {text, text ? strlen(text) : 0, SKEIN_JSON};
  return value;
}

static inline skein_value skein_struct(const void* data, size_t size) {
  skein_value value = {data, size, SKEIN_STRUCT};
  return value;
}

static inline skein_value skein_cdr(const void* data, size_t size) {
  skein_value value = {data, size, SKEIN_CDR};
  return value;
}

/* A service as a value: what an IDL type has where it names an interface. */
typedef struct skein_reference {
  const char* interface_name;
  uint8_t provider[16]; /* All 0: no service. */
  const char* instance;
} skein_reference;

/* A place for errors; 0 if memory is exhausted. It keeps the last error that was put there until it
 * is cleared: success leaves it as it is. What the following functions give holds until the next
 * error comes, or the error is cleared or freed; so let one thread at a time use it. */
skein_error skein_error_new(void);
bool skein_error_free(skein_error error);
/* SKEIN_OK if there is none. */
skein_error_kind skein_error_class(skein_error error);
/* Cause, place and remedy; "" if there is none. */
const char* skein_error_text(skein_error error);
/* Of an exception that the interface declares: its scoped IDL name and its members, as the call
 * that failed was encoded, but CDR in place of a struct. Returns false for every other error. */
bool skein_error_exception(skein_error error, const char** name, skein_value* members);
bool skein_error_clear(skein_error error);
/* Puts an error there: how a callback gives its reason. NULL is "". */
bool skein_error_set(skein_error error, skein_error_kind kind, const char* text);

/* ---- results ---- */

/* The value, which holds until the result is freed. */
bool skein_result_value(skein_result result, skein_value* value, skein_error error);
/* 0 is no error, as in all `_free` functions. */
bool skein_result_free(skein_result result, skein_error error);

/* ---- entities ---- */

/* Members that are 0 or NULL have their defaults. `reserved` must be 0. */
typedef struct skein_entity_options {
  const char* name;   /* Required: letters, digits, `_`, `-` and `.`; the same for `system`. */
  const char* system; /* The vehicle or station; default: `default`. */
  const char* vendor; /* Required: `cyclonedds`, `fastdds` or, within the process, `loopback`. */
  const char* const* network; /* `network_size` interfaces or IPv4 addresses; default: 127.0.0.1. */
  size_t network_size;
  const char* const* peers; /* `peers_size` hosts on which to look for participants. */
  size_t peers_size;
  uint32_t domain;             /* 0 to 232. */
  bool multicast;              /* Discover participants by multicast, on a named interface. */
  bool no_shared_memory_calls; /* Calls on this host go over DDS, too. */
  int64_t lease_ns;            /* A peer that is silent for so long is lost; default: 1 s. */
  uint64_t reserved[4];
} skein_entity_options;

/* Joins the mission: an autonomous entity with one DDS participant. */
bool skein_entity_new(const skein_entity_options* options, skein_entity* out, skein_error error);
/* Leaves the mission: ends its publishers and subscriptions, withdraws its services, and ends all
 * connections; pending calls end as SKEIN_DISCONNECTED, waits for a provider as SKEIN_UNAVAILABLE.
 * Proxies and calls may outlive it. Waits for running functions that use the entity, for running
 * callbacks of subscriptions, and at most 2 s for calls that hang. Refused in a callback of this
 * entity. */
bool skein_entity_free(skein_entity entity, skein_error error);
/* `system/name`; holds until the entity is freed. */
bool skein_entity_id(skein_entity entity, const char** out, skein_error error);
/* Withdraws all services without loss: tells clients to go elsewhere, and serves what they had
 * sent. `drained` (may be NULL) is false if that took longer than `patience_ns`. Waits. Refused in
 * a callback of this entity. */
bool skein_entity_drain(skein_entity entity, int64_t patience_ns, bool* drained, skein_error error);

/* ---- interfaces ---- */

/* What a program knows of an IDL interface: its operations and their types; or of types alone. Made
 * of a description that the IDL compiler writes for C. The bytes are copied. */
bool skein_interface_new(const void* description, size_t size, skein_interface* out,
                         skein_error error);
/* Asks a service that runs now; `name` is of an interface or an entity. Waits until there is one,
 * at most `timeout_ns`; 0: 5 s. */
bool skein_interface_fetch(skein_entity entity, const char* name, int64_t timeout_ns,
                           skein_interface* out, skein_error error);
/* Asks an entity that publishes or subscribes to the topic for its types. Waits likewise. */
bool skein_interface_fetch_topic(skein_entity entity, const char* topic, int64_t timeout_ns,
                                 skein_interface* out, skein_error error);
/* Canonical name, `AE_navigator/INavigator`; holds until the interface is freed. */
bool skein_interface_name(skein_interface interface, const char** out, skein_error error);
/* The description: as CDR what skein_interface_new() takes; as JSON for people and generators. */
bool skein_interface_describe(skein_interface interface, skein_encoding encoding, skein_result* out,
                              skein_error error);
/* Arguments that the operation takes, as JSON, all with their initial values. */
bool skein_interface_example(skein_interface interface, const char* operation, skein_result* out,
                             skein_error error);
/* A value of one of the interface's types, or of an operation's arguments (`wind`) or results
 * (`wind.out`), in another encoding. */
bool skein_interface_convert(skein_interface interface, const char* type, skein_value value,
                             skein_encoding encoding, skein_result* out, skein_error error);
bool skein_interface_free(skein_interface interface, skein_error error);

/* ---- calls ---- */

typedef int32_t skein_relation;
enum { SKEIN_EQUAL = 0, SKEIN_NOT_EQUAL = 1, SKEIN_AT_MOST = 2, SKEIN_AT_LEAST = 3 };

/* A condition on an attribute that providers declare: `latency` AT_MOST `300`. */
typedef struct skein_constraint {
  const char* attribute;
  const char* value;
  skein_relation relation;
} skein_constraint;

/* Which provider to connect to. Members that are 0 or NULL have their defaults. */
typedef struct skein_connect_options {
  const char* name;     /* Of an interface or an entity; default: the interface. */
  const char* system;   /* Another vehicle or station, `*` for any; default: the entity's own. */
  const char* strategy; /* Of the provider's Head for this session. */
  const char* preferred_host; /* `.` for this host. */
  const uint8_t* provider;    /* 16 bytes: only this provider. */
  const skein_constraint* constraints;
  size_t constraints_size;
  int64_t timeout_ns;     /* To find a provider and connect; default: 5 s. */
  int64_t hedge_after_ns; /* Idempotent calls without an answer are then made elsewhere, too. */
  uint64_t reserved[4];
} skein_connect_options;

/* Connects to a provider of the interface; each later call goes to the current one, or to another
 * if that is lost. `options` may be NULL. Waits. */
bool skein_proxy_connect(skein_entity entity, skein_interface interface,
                         const skein_connect_options* options, skein_proxy* out, skein_error error);
/* Whether calls can be made. */
bool skein_proxy_connected(skein_proxy proxy, bool* out, skein_error error);
/* Ends the connection: pending calls end as SKEIN_CANCELLED. */
bool skein_proxy_free(skein_proxy proxy, skein_error error);

/* Calls an operation and waits for its result, at most `timeout_ns`; 0: 5 s. The result is encoded
 * as the arguments are. `out` may be NULL. */
bool skein_proxy_call(skein_proxy proxy, const char* operation, skein_value arguments,
                      int64_t timeout_ns, skein_result* out, skein_error error);

/* `result` is NULL if the call has failed; then `error` says why. Both hold during the call of
 * `on_result` alone. It runs on the entity's thread for continuations: one that takes long holds up
 * the others. */
typedef struct skein_call_callbacks {
  void* user;
  void (*on_result)(void* user, const skein_value* result, skein_error error);
  void (*on_close)(void* user);
} skein_call_callbacks;

/* Begins a call, and returns at once. With callbacks its end is told; without (NULL), wait for it.
 * `out` may be NULL with callbacks. The arguments are read before this returns. */
bool skein_proxy_start(skein_proxy proxy, const char* operation, skein_value arguments,
                       int64_t timeout_ns, const skein_call_callbacks* callbacks, skein_call* out,
                       skein_error error);
/* Waits for the end of a call without callbacks, once. `out` may be NULL. */
bool skein_call_wait(skein_call call, skein_result* out, skein_error error);
/* Cancels the call, unless it has ended: it ends as SKEIN_CANCELLED. */
bool skein_call_cancel(skein_call call, skein_error error);
/* Cancels the call, unless it has ended. Allowed in its own callback. */
bool skein_call_free(skein_call call, skein_error error);

/* `item` is NULL at the end of the stream; then `error` is 0, or says what ended it. Both hold
 * during the call of `on_item` alone, which runs as on_result(). A slow one slows the provider. */
typedef struct skein_stream_callbacks {
  void* user;
  void (*on_item)(void* user, const skein_value* item, skein_error error);
  void (*on_close)(void* user);
} skein_stream_callbacks;

/* Calls an operation that returns a stream. The timeout is that of the whole stream. With callbacks
 * its results are told; without (NULL), take them by skein_stream_next(). */
bool skein_proxy_stream(skein_proxy proxy, const char* operation, skein_value arguments,
                        int64_t timeout_ns, const skein_stream_callbacks* callbacks,
                        skein_stream* out, skein_error error);
/* Waits for the next result of a stream without callbacks; at the end `*out` is 0. */
bool skein_stream_next(skein_stream stream, skein_result* out, skein_error error);
/* Cancels the operation, unless it has ended, and drops results that were not taken. Allowed in its
 * own callback. */
bool skein_stream_free(skein_stream stream, skein_error error);

/* ---- providing ---- */

typedef struct skein_attribute {
  const char* name;
  const char* value;
} skein_attribute;

/* Members that are 0 or NULL have their defaults. */
typedef struct skein_service_options {
  const skein_attribute* attributes; /* `latency` in ms or with a unit, `quality`, ... */
  size_t attributes_size;
  const char* component; /* The component description as XML. */
  const char* csp;   /* The name of a CSP, which only its owner may use; then `owner` is needed. */
  const char* owner; /* `system/name`: skein_entity_id() of the owner. */
  size_t threads;    /* Own threads for the calls; default: 1. */
  size_t queue;      /* Calls that may wait; default: 2048. */
  skein_encoding encoding; /* Of the arguments that `on_call` gets. */
  uint64_t reserved[4];
} skein_service_options;

/* `operation` and `arguments` hold until the reply has ended; for streams and oneway operations
 * until `on_call` returns. The reply may be answered in `on_call`, or later on any thread: until
 * then the call occupies no thread. It ends when it is answered, failed, raised or freed. The
 * replies of a stream and of a oneway operation end when `on_call` returns, and need no answer. */
typedef struct skein_service_callbacks {
  void* user;
  void (*on_call)(void* user, const char* operation, const skein_value* arguments,
                  skein_reply reply);
  void (*on_close)(void* user);
} skein_service_callbacks;

/* Provides a service, or a CSP. `options` may be NULL; `on_call` is required. */
bool skein_provider_new(skein_entity entity, skein_interface interface,
                        const skein_service_options* options,
                        const skein_service_callbacks* callbacks, skein_provider* out,
                        skein_error error);
/* Its identity, 16 bytes. */
bool skein_provider_identity(skein_provider provider, uint8_t out[16], skein_error error);
/* Withdraws the service, unless its entity has ended: calls that have no answer end as
 * SKEIN_DISCONNECTED. Waits for running callbacks, at most 2 s. Refused in a callback of the
 * provider. */
bool skein_provider_free(skein_provider provider, skein_error error);

/* Answers with the result, and ends the reply. If the value is refused, the reply goes on. If the
 * caller has given up, or the service was withdrawn, the answer goes nowhere. */
bool skein_reply_answer(skein_reply reply, skein_value result, skein_error error);
/* Answers with an error: SKEIN_UNAVAILABLE to SKEIN_INTERNAL. Ends the reply; so does raise(). */
bool skein_reply_fail(skein_reply reply, skein_error_kind kind, const char* text,
                      skein_error error);
/* Answers with an exception that the operation declares, by its scoped IDL name and its members. */
bool skein_reply_raise(skein_reply reply, const char* exception, skein_value members,
                       skein_error error);
/* A stream's next result. Waits while the caller is too far behind; with `sent` it does not wait,
 * and tells whether it was sent. Fails as SKEIN_CANCELLED if nobody waits for it any more. */
bool skein_reply_push(skein_reply reply, skein_value item, bool* sent, skein_error error);
/* Whether nobody waits for the answer any more. */
bool skein_reply_cancelled(skein_reply reply, bool* out, skein_error error);
/* Until the caller's deadline; less than 0 if it has passed. */
bool skein_reply_time_left(skein_reply reply, int64_t* out_ns, skein_error error);
/* Calls `on_cancel` once nobody waits for the answer any more, at once if that is so, not after the
 * answer. At most once for a reply, which may not be that of a stream. `on_close` is called when
 * the reply has ended. */
typedef struct skein_cancel_callbacks {
  void* user;
  void (*on_cancel)(void* user);
  void (*on_close)(void* user);
} skein_cancel_callbacks;
bool skein_reply_on_cancel(skein_reply reply, const skein_cancel_callbacks* callbacks,
                           skein_error error);
/* Ends the reply; without an answer the caller gets SKEIN_INTERNAL. */
bool skein_reply_free(skein_reply reply, skein_error error);

/* ---- topics ---- */

/* What fits the data. */
typedef int32_t skein_topic_profile;
enum {
  SKEIN_TOPIC_EVERY_VALUE = 0, /* Reliable, in order. */
  SKEIN_TOPIC_SENSOR = 1,  /* Best effort; only new values matter: `period_ns` is their lifespan. */
  SKEIN_TOPIC_COMMAND = 2, /* The newest value of the strongest publisher, once per `period_ns`. */
  SKEIN_TOPIC_STATE = 3    /* The last value of each key, also for late joiners. */
};

/* Members that are 0 or NULL have their defaults. Use the same profile on both sides. */
typedef struct skein_topic_options {
  const char* const* systems; /* `systems_size` systems; default: the entity's own. */
  size_t systems_size;
  int64_t period_ns; /* See the profiles; default: 500 ms for sensors, 100 ms for commands. */
  skein_topic_profile profile;
  int32_t strength;        /* Of a publisher of commands. */
  skein_encoding encoding; /* Of the values that `on_value` gets. */
  uint64_t reserved[4];
} skein_topic_options;

/* `type` is the scoped name of one of the interface's types; NULL: that of the topic that was
 * fetched. `options` may be NULL. */
bool skein_publisher_new(skein_entity entity, skein_interface types, const char* type,
                         const char* topic, const skein_topic_options* options,
                         skein_publisher* out, skein_error error);
/* Fails as SKEIN_OVERLOADED if reliable subscribers make no room in time. */
bool skein_publisher_publish(skein_publisher publisher, skein_value value, skein_error error);
/* How many subscribers are matched now. */
bool skein_publisher_subscribers(skein_publisher publisher, size_t* out, skein_error error);
/* Waits until all reliable subscribers that are matched now have what was published; `acknowledged`
 * (may be NULL) is false if they have not by the timeout. */
bool skein_publisher_wait(skein_publisher publisher, int64_t timeout_ns, bool* acknowledged,
                          skein_error error);
/* Ends it. Waits for running functions that use it. */
bool skein_publisher_free(skein_publisher publisher, skein_error error);

/* `value` holds until `on_value` returns. It runs on the entity's thread for topics. */
typedef struct skein_subscription_callbacks {
  void* user;
  void (*on_value)(void* user, const skein_value* value);
  void (*on_close)(void* user);
} skein_subscription_callbacks;

/* As skein_publisher_new(); `on_value` is required. */
bool skein_subscription_new(skein_entity entity, skein_interface types, const char* type,
                            const char* topic, const skein_topic_options* options,
                            const skein_subscription_callbacks* callbacks, skein_subscription* out,
                            skein_error error);
/* How many publishers are matched now. */
bool skein_subscription_publishers(skein_subscription subscription, size_t* out, skein_error error);
/* Ends it. Waits for a running callback. Refused in its own callback. */
bool skein_subscription_free(skein_subscription subscription, skein_error error);

/* ---- the Head ---- */

typedef int32_t skein_execution;
enum {
  SKEIN_EXECUTE_ONE = 0, /* The next CSP begins when one has failed or used up its time slice. */
  SKEIN_EXECUTE_STAGGERED = 1, /* The next also begins when the last is late; all continue. */
  SKEIN_EXECUTE_ALL = 2        /* All begin at once. */
};

typedef struct skein_feature {
  const char* name;
  double value;
} skein_feature;

/* A task for CSPs that the Head selects. Members that are 0 or NULL have their defaults. */
typedef struct skein_task {
  const char*
      operation; /* Required: that each CSP is asked for; of a stream the last result counts. */
  skein_value arguments;
  const char* request;           /* The request's name in the record. */
  const char* only;              /* Only the CSP with this name. */
  const skein_feature* features; /* Properties of the request that may matter for the choice. */
  size_t features_size;
  size_t width;     /* How many CSPs work at a time; default: as many as there are. */
  size_t enough;    /* How many accepted results are needed; default: 1; SIZE_MAX: all. */
  int64_t limit_ns; /* Default: 60 s. */
  skein_execution execution;
  uint64_t reserved[4];
} skein_task;

/* Each may be NULL, and runs in skein_entity_perform(), on its thread. Results hold during the call
 * of the function alone. */
typedef struct skein_task_callbacks {
  void* user;
  /* Whether the result is accepted; if not, skein_error_set() gives the reason. */
  bool (*evaluate)(void* user, const skein_value* result, skein_error reason);
  /* The quality of an accepted result, for the history. */
  double (*quality)(void* user, const skein_value* result);
  /* Of several accepted results that with the lowest cost is taken; NULL: the best by quality. */
  double (*cost)(void* user, const skein_value* result);
} skein_task_callbacks;

/* Has the entity's Head run the task, and waits. `callbacks` may be NULL, as may `out` and
 * `decision`, which gets the record of the decision as JSON, also if the task fails. Fails as
 * SKEIN_UNAVAILABLE if no CSP is available, SKEIN_INTERNAL if the results were rejected, or as the
 * last attempt failed. */
bool skein_entity_perform(skein_entity entity, skein_interface interface, const skein_task* task,
                          const skein_task_callbacks* callbacks, skein_result* out,
                          skein_result* decision, skein_error error);

/* ---- the log and the process ---- */

typedef int32_t skein_log_level;
enum { SKEIN_LOG_DEBUG = 0, SKEIN_LOG_INFO = 1, SKEIN_LOG_WARNING = 2, SKEIN_LOG_ERROR = 3 };

/* Logs a line; `place` is a part of the program. `skein log` shows it. */
bool skein_log_write(skein_log_level level, const char* place, const char* text, skein_error error);
/* Lines below `least` are dropped; default: SKEIN_LOG_INFO, or the environment variable SKEIN_LOG.
 */
bool skein_log_set_level(skein_log_level least, skein_error error);

/* The texts hold until `on_line` returns; `time_ns` is that of the system's clock. It must not log.
 * Of one that falls 4096 lines behind, lines are lost. */
typedef struct skein_log_callbacks {
  void* user;
  void (*on_line)(void* user, skein_log_level level, const char* place, const char* text,
                  int64_t time_ns);
  void (*on_close)(void* user);
} skein_log_callbacks;
/* Replaces what gets the lines, which closes the last one; NULL: standard error. */
bool skein_log_set_sink(const skein_log_callbacks* callbacks, skein_error error);

/* Waits until the process is told to end: SIGTERM, SIGINT (Ctrl-C) or SIGHUP, and gives the signal
 * (`out` may be NULL). Only one thread may wait. */
bool skein_signal_wait(int32_t* out, skein_error error);

#ifdef __cplusplus
}
#endif

#endif
