/* A service and its client in C99, compiled with the strictest warnings: c99_program VENDOR. */
#include <stdio.h>
#include <stdlib.h>

#include "buoy.idl.h"

static skein_error failure;

#define DEMAND(condition)                                                                   \
  ((condition)                                                                              \
       ? (void)0                                                                            \
       : (fprintf(stderr, "%d: %s: %s\n", __LINE__, #condition, skein_error_text(failure)), \
          exit(1)))

static void wind(void* user, const harbour_IBuoy_wind_in* in, skein_reply reply) {
  if (in->level == 0) {
    harbour_Fog fog = {"it lies low", 0.5};
    fog.sight_m = in->at;
    DEMAND(harbour_Fog_raise(reply, &fog, failure));
    return;
  }
  harbour_Wind result = {0, 0, harbour_Side_Starboard};
  result.force = in->level;
  result.speed_m_s = in->at * *(double*)user;
  DEMAND(harbour_IBuoy_wind_answer(reply, &result, 77, failure));
}

static void greet(void* user, const harbour_IBuoy_greet_in* in, skein_reply reply) {
  char text[100];
  (void)user;
  snprintf(text, sizeof text, "Ahoy, %s", in->name);
  DEMAND(harbour_IBuoy_greet_answer(reply, text, failure));
}

static void gusts(void* user, const harbour_IBuoy_gusts_in* in, skein_reply reply) {
  (void)user;
  for (int32_t i = 0; i < in->count; ++i) {
    harbour_Wind gust = {0, 0, harbour_Side_Port};
    gust.force = (uint8_t)i;
    DEMAND(harbour_IBuoy_gusts_push(reply, &gust, failure));
  }
}

static void on_close(void* user) { *(double*)user = 0; }

int main(int count, char** arguments) {
  static double factor = 2;
  failure = skein_error_new();
  skein_entity_options options = {.name = "c99", .system = "uav-1", .domain = 17};
  options.vendor = count > 1 ? arguments[1] : "loopback";
  skein_entity entity;
  DEMAND(skein_entity_new(&options, &entity, failure));
  const harbour_IBuoy_functions functions = {
      .wind = wind, .greet = greet, .gusts = gusts, .on_close = on_close};
  skein_provider provider;
  DEMAND(harbour_IBuoy_provide(entity, NULL, &functions, &factor, &provider, failure));
  skein_proxy proxy;
  DEMAND(harbour_IBuoy_connect(entity, NULL, &proxy, failure));

  skein_result result;
  const harbour_IBuoy_wind_out* winds;
  DEMAND(harbour_IBuoy_wind(proxy, 3, 1.25, &result, &winds, failure));
  DEMAND(winds->return_.force == 3 && winds->return_.speed_m_s == 2.5 && winds->stamp == 77);
  DEMAND(skein_result_free(result, failure));
  const harbour_IBuoy_greet_out* greeting;
  DEMAND(harbour_IBuoy_greet(proxy, "you", &result, &greeting, failure));
  DEMAND(strcmp(greeting->return_, "Ahoy, you") == 0);
  DEMAND(skein_result_free(result, failure));

  DEMAND(!harbour_IBuoy_wind(proxy, 0, 8, &result, &winds, failure));
  const char* name;
  skein_value members;
  DEMAND(skein_error_class(failure) == SKEIN_DECLARED);
  DEMAND(skein_error_exception(failure, &name, &members) && strcmp(name, harbour_Fog_TYPE) == 0);
  const harbour_IBuoy_after_out* after;
  DEMAND(!harbour_IBuoy_after(proxy, 1, &result, &after, failure));
  DEMAND(skein_error_class(failure) == SKEIN_UNIMPLEMENTED);

  skein_stream stream;
  DEMAND(harbour_IBuoy_gusts(proxy, 12, &stream, failure));
  const harbour_IBuoy_gusts_out* gust;
  int number = 0;
  while (harbour_IBuoy_gusts_next(stream, &result, &gust, failure) && gust) {
    DEMAND(gust->return_.force == number++);
    DEMAND(skein_result_free(result, failure));
  }
  DEMAND(number == 12);
  DEMAND(skein_entity_free(entity, failure));
  DEMAND(factor == 0);
  DEMAND(skein_error_free(failure));
  puts("all well");
  return 0;
}
