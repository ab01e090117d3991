/* One side of the table of languages, in C: table_peer_c VENDOR SHARED_MEMORY provide|check. See
 * table.py. */
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "buoy.idl.h"

static skein_error failure;
static const skein_error ignored = {0};
static atomic_int begun;
static atomic_int cancelled;
static atomic_bool told;

#define DEMAND(condition) \
  ((condition) ? (void)0 : (fprintf(stderr, "%s\n", skein_error_text(failure)), exit(1)))

static void tell(const char* feature, bool right) {
  printf("%s %s\n", feature, right ? "ok" : "wrong");
  fflush(stdout);
}

static void pause_briefly(void) {
  const struct timespec two_milliseconds = {0, 2000000};
  nanosleep(&two_milliseconds, NULL);
}

/* ---- the provider ---- */

static void wind(void* user, const harbour_IBuoy_wind_in* in, skein_reply reply) {
  const harbour_Wind answer = {in->level, in->at * 2, harbour_Side_Starboard};
  const harbour_Fog fog = {"it lies low", in->at};
  (void)user;
  if (in->level == 0)
    harbour_Fog_raise(reply, &fog, ignored);
  else
    harbour_IBuoy_wind_answer(reply, &answer, 77, ignored);
}

static void greet(void* user, const harbour_IBuoy_greet_in* in, skein_reply reply) {
  char text[80];
  (void)user;
  if (strcmp(in->name, "cancelled") == 0)
    snprintf(text, sizeof text, "%d cancelled", cancelled);
  else if (strcmp(in->name, "begun") == 0)
    snprintf(text, sizeof text, "%d begun", begun);
  else
    snprintf(text, sizeof text, "Ahoy, %s", in->name);
  harbour_IBuoy_greet_answer(reply, text, ignored);
}

static void gusts(void* user, const harbour_IBuoy_gusts_in* in, skein_reply reply) {
  (void)user;
  for (int32_t i = 0; i < in->count; ++i) {
    const harbour_Wind gust = {(uint8_t)i, i + 0.5, harbour_Side_Port};
    if (!harbour_IBuoy_gusts_push(reply, &gust, ignored)) return;
  }
}

static void on_cancel(void* user) {
  (void)user;
  ++cancelled;
}

/* Answers when nobody waits any more. */
static void after(void* user, const harbour_IBuoy_after_in* in, skein_reply reply) {
  const skein_cancel_callbacks callbacks = {NULL, on_cancel, NULL};
  (void)user;
  (void)in;
  skein_reply_on_cancel(reply, &callbacks, ignored);
  ++begun;
}

static void report(void* user, const harbour_IReporter_report_in* in, skein_reply reply) {
  harbour_Report answer = in->earlier;
  (void)user;
  answer.place = "C";
  harbour_IReporter_report_answer(reply, &answer, ignored);
}

static void provide(skein_entity entity) {
  const harbour_IBuoy_functions functions = {
      .wind = wind, .greet = greet, .gusts = gusts, .after = after};
  const harbour_IReporter_functions reporting = {.report = report};
  const skein_service_options csp = {.csp = "C", .owner = "uav-1/checker"};
  const skein_topic_options state = {.profile = SKEIN_TOPIC_STATE};
  const harbour_Depth depth = {"quay", 4.5};
  skein_provider provider;
  skein_interface types;
  skein_publisher publisher;
  DEMAND(harbour_IBuoy_provide(entity, NULL, &functions, NULL, &provider, failure));
  DEMAND(harbour_IReporter_provide(entity, &csp, &reporting, NULL, &provider, failure));
  DEMAND(buoy_types(&types, failure));
  DEMAND(
      skein_publisher_new(entity, types, harbour_Depth_TYPE, "depth", &state, &publisher, failure));
  DEMAND(skein_publisher_publish(publisher, skein_struct(&depth, sizeof depth), failure));
  puts("provides");
  fflush(stdout);
  getchar();
}

/* ---- the caller ---- */

static bool calls(skein_proxy buoy) {
  skein_result result;
  const harbour_IBuoy_wind_out* out;
  const char* name;
  skein_value members;
  DEMAND(harbour_IBuoy_wind(buoy, 3, 1.5, &result, &out, failure));
  bool right = out->return_.force == 3 && out->return_.speed_m_s == 3 && out->stamp == 77;
  skein_result_free(result, failure);
  return right && !harbour_IBuoy_wind(buoy, 0, 1.25, &result, &out, failure) &&
         skein_error_exception(failure, &name, &members) && strcmp(name, harbour_Fog_TYPE) == 0;
}

static bool calls_later(skein_proxy buoy) {
  skein_call begun[20];
  char text[20];
  bool right = true;
  for (int i = 0; i < 20; ++i) {
    snprintf(text, sizeof text, "%d", i);
    DEMAND(harbour_IBuoy_greet_start(buoy, text, NULL, &begun[i], failure));
  }
  for (int i = 0; i < 20; ++i) {
    skein_result result;
    skein_value value;
    DEMAND(skein_call_wait(begun[i], &result, failure));
    DEMAND(skein_result_value(result, &value, failure));
    snprintf(text, sizeof text, "Ahoy, %d", i);
    right = right && strcmp(((const harbour_IBuoy_greet_out*)value.data)->return_, text) == 0;
    skein_result_free(result, failure);
    skein_call_free(begun[i], failure);
  }
  return right;
}

static bool streams(skein_proxy buoy) {
  skein_stream stream;
  skein_result result;
  const harbour_IBuoy_gusts_out* out;
  int next = 0;
  DEMAND(harbour_IBuoy_gusts(buoy, 20, &stream, failure));
  for (;;) {
    DEMAND(harbour_IBuoy_gusts_next(stream, &result, &out, failure));
    if (!out) break;
    next += out->return_.force == next ? 1 : 100;
    skein_result_free(result, failure);
  }
  skein_stream_free(stream, failure);
  return next == 20;
}

static void on_depth(void* user, const skein_value* value) {
  const harbour_Depth* depth = value->data;
  (void)user;
  if (strcmp(depth->place, "quay") == 0 && depth->depth_m == 4.5) told = true;
}

static bool subscribes(skein_entity entity) {
  const skein_topic_options state = {.profile = SKEIN_TOPIC_STATE, .encoding = SKEIN_STRUCT};
  const skein_subscription_callbacks callbacks = {NULL, on_depth, NULL};
  skein_interface types;
  skein_subscription subscription;
  DEMAND(buoy_types(&types, failure));
  DEMAND(skein_subscription_new(entity, types, harbour_Depth_TYPE, "depth", &state, &callbacks,
                                &subscription, failure));
  for (int i = 0; !told && i < 10000; ++i) pause_briefly();
  DEMAND(skein_subscription_free(subscription, failure));
  return told;
}

static bool performs(skein_entity entity) {
  harbour_IReporter_report_in in = {.earlier = {.place = "quay"}};
  skein_task task = {.operation = "report", .arguments = {&in, sizeof in, SKEIN_STRUCT}};
  skein_interface interface;
  DEMAND(harbour_IReporter_interface(&interface, failure));
  for (int i = 0; i < 10000; ++i) {
    if (skein_entity_perform(entity, interface, &task, NULL, NULL, NULL, failure)) return true;
    pause_briefly();
  }
  return false;
}

/* Until the provider has counted one. */
static bool await_count(skein_proxy buoy, const char* of) {
  for (int i = 0; i < 10000; ++i) {
    skein_result result;
    const harbour_IBuoy_greet_out* out;
    DEMAND(harbour_IBuoy_greet(buoy, of, &result, &out, failure));
    const bool counted = out->return_[0] != '0';
    skein_result_free(result, failure);
    if (counted) return true;
    pause_briefly();
  }
  return false;
}

static bool cancels(skein_proxy buoy) {
  skein_call slow;
  DEMAND(harbour_IBuoy_after_start(buoy, 60000, NULL, &slow, failure));
  if (!await_count(buoy, "begun")) return false;
  DEMAND(skein_call_cancel(slow, failure));
  return await_count(buoy, "cancelled");
}

static bool keeps_deadlines(skein_proxy buoy) {
  const harbour_IBuoy_after_in in = {60000};
  return !skein_proxy_call(buoy, "after", skein_struct(&in, sizeof in), SKEIN_SECOND / 10, NULL,
                           failure) &&
         skein_error_class(failure) == SKEIN_TIMED_OUT;
}

static void check(skein_entity entity) {
  const skein_connect_options patiently = {.timeout_ns = 30 * SKEIN_SECOND};
  skein_proxy buoy;
  DEMAND(harbour_IBuoy_connect(entity, &patiently, &buoy, failure));
  tell("call", calls(buoy));
  tell("asynchronous", calls_later(buoy));
  tell("stream", streams(buoy));
  tell("topics", subscribes(entity));
  tell("CSP", performs(entity));
  tell("cancel", cancels(buoy));
  tell("deadline", keeps_deadlines(buoy));
}

int main(int count, char** arguments) {
  skein_entity_options options = {.system = "uav-1", .domain = 17, .lease_ns = 60 * SKEIN_SECOND};
  skein_entity entity;
  if (count != 4) return 2;
  const bool provides = strcmp(arguments[3], "provide") == 0;
  options.vendor = arguments[1];
  options.no_shared_memory_calls = strcmp(arguments[2], "yes") != 0;
  options.name = provides ? "provider" : "checker";
  failure = skein_error_new();
  DEMAND(skein_entity_new(&options, &entity, failure));
  if (provides)
    provide(entity);
  else
    check(entity);
  DEMAND(skein_entity_free(entity, failure));
  return 0;
}
