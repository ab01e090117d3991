/* One side of a call that takes for ever, in C: buoy_peer VENDOR provide|call. It tells what
 * happens by lines, and is meant to be killed. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "buoy.idl.h"

static skein_error failure;

#define DEMAND(condition) \
  ((condition) ? (void)0 : (fprintf(stderr, "%s\n", skein_error_text(failure)), exit(1)))

static void tell(const char* line) {
  puts(line);
  fflush(stdout);
}

static void on_cancel(void* user) { tell(user); }

/* Who asks for nobody is never answered. */
static void greet(void* user, const harbour_IBuoy_greet_in* in, skein_reply reply) {
  const skein_cancel_callbacks callbacks = {"cancelled", on_cancel, NULL};
  (void)user;
  if (strcmp(in->name, "nobody") != 0) {
    DEMAND(harbour_IBuoy_greet_answer(reply, in->name, failure));
    return;
  }
  DEMAND(skein_reply_on_cancel(reply, &callbacks, failure));
  tell("called");
}

static void provide(skein_entity entity) {
  const harbour_IBuoy_functions functions = {.greet = greet};
  skein_provider provider;
  DEMAND(harbour_IBuoy_provide(entity, NULL, &functions, NULL, &provider, failure));
  tell("provides");
  getchar();
}

static void call(skein_entity entity) {
  skein_proxy proxy;
  skein_result result;
  const harbour_IBuoy_greet_out* out;
  DEMAND(harbour_IBuoy_connect(entity, NULL, &proxy, failure));
  DEMAND(harbour_IBuoy_greet(proxy, "nobody", &result, &out, failure));
}

int main(int count, char** arguments) {
  /* So long that nobody is missed before the kernel tells of his end. */
  skein_entity_options options = {.system = "uav-1", .domain = 17, .lease_ns = 60 * SKEIN_SECOND};
  skein_entity entity;
  if (count != 3) return 2;
  options.vendor = arguments[1];
  options.name = arguments[2];
  failure = skein_error_new();
  DEMAND(skein_entity_new(&options, &entity, failure));
  if (strcmp(arguments[2], "provide") == 0)
    provide(entity);
  else
    call(entity);
  return 0;
}
