/* A service and its caller in C. */
#include <stdio.h>
#include <stdlib.h>

#include "greeter.idl.h"

static void check(bool done, skein_error error) {
  if (done) return;
  fprintf(stderr, "%s\n", skein_error_text(error));
  exit(1);
}

static void greet(void* user, const greeting_IGreeter_greet_in* in, skein_reply reply) {
  char text[80];
  skein_error ignored = {0};
  snprintf(text, sizeof text, "%s, %s!", (const char*)user, in->name);
  greeting_IGreeter_greet_answer(reply, text, ignored);
}

int main(void) {
  skein_error error = skein_error_new();
  skein_entity entity;
  skein_entity_options options = {.name = "greeter", .vendor = "loopback"};
  check(skein_entity_new(&options, &entity, error), error);

  greeting_IGreeter_functions functions = {.greet = greet};
  skein_provider provider;
  check(greeting_IGreeter_provide(entity, NULL, &functions, "Hello", &provider, error), error);

  skein_proxy proxy;
  skein_result result;
  const greeting_IGreeter_greet_out* out;
  check(greeting_IGreeter_connect(entity, NULL, &proxy, error), error);
  check(greeting_IGreeter_greet(proxy, "world", &result, &out, error), error);
  printf("%s\n", out->return_);
  skein_result_free(result, error);
  check(skein_entity_free(entity, error), error);
  return 0;
}
