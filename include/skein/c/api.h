/* The functions of skein.h as a table, for programs that load the library at run time: one symbol
 * to look up. */
#ifndef SKEIN_C_API_H
#define SKEIN_C_API_H

#include "skein/c/skein.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Later versions only add functions, at the end. */
#define SKEIN_API_VERSION 1

/* Each does what the function of skein.h does that has its name behind `skein_`. */
typedef struct skein_api {
  uint32_t version;
  skein_error (*error_new)(void);
  bool (*error_free)(skein_error error);
  skein_error_kind (*error_class)(skein_error error);
  const char* (*error_text)(skein_error error);
  bool (*error_exception)(skein_error error, const char** name, skein_value* members);
  bool (*error_clear)(skein_error error);
  bool (*error_set)(skein_error error, skein_error_kind kind, const char* text);
  bool (*result_value)(skein_result result, skein_value* value, skein_error error);
  bool (*result_free)(skein_result result, skein_error error);
  bool (*entity_new)(const skein_entity_options* options, skein_entity* out, skein_error error);
  bool (*entity_free)(skein_entity entity, skein_error error);
  bool (*entity_id)(skein_entity entity, const char** out, skein_error error);
  bool (*entity_drain)(skein_entity entity, int64_t patience_ns, bool* drained, skein_error error);
  bool (*interface_new)(const void* description, size_t size, skein_interface* out,
                        skein_error error);
  bool (*interface_fetch)(skein_entity entity, const char* name, int64_t timeout_ns,
                          skein_interface* out, skein_error error);
  bool (*interface_fetch_topic)(skein_entity entity, const char* topic, int64_t timeout_ns,
                                skein_interface* out, skein_error error);
  bool (*interface_name)(skein_interface interface, const char** out, skein_error error);
  bool (*interface_describe)(skein_interface interface, skein_encoding encoding, skein_result* out,
                             skein_error error);
  bool (*interface_example)(skein_interface interface, const char* operation, skein_result* out,
                            skein_error error);
  bool (*interface_convert)(skein_interface interface, const char* type, skein_value value,
                            skein_encoding encoding, skein_result* out, skein_error error);
  bool (*interface_free)(skein_interface interface, skein_error error);
  bool (*proxy_connect)(skein_entity entity, skein_interface interface,
                        const skein_connect_options* options, skein_proxy* out, skein_error error);
  bool (*proxy_connected)(skein_proxy proxy, bool* out, skein_error error);
  bool (*proxy_free)(skein_proxy proxy, skein_error error);
  bool (*proxy_call)(skein_proxy proxy, const char* operation, skein_value arguments,
                     int64_t timeout_ns, skein_result* out, skein_error error);
  bool (*proxy_start)(skein_proxy proxy, const char* operation, skein_value arguments,
                      int64_t timeout_ns, const skein_call_callbacks* callbacks, skein_call* out,
                      skein_error error);
  bool (*call_wait)(skein_call call, skein_result* out, skein_error error);
  bool (*call_cancel)(skein_call call, skein_error error);
  bool (*call_free)(skein_call call, skein_error error);
  bool (*proxy_stream)(skein_proxy proxy, const char* operation, skein_value arguments,
                       int64_t timeout_ns, const skein_stream_callbacks* callbacks,
                       skein_stream* out, skein_error error);
  bool (*stream_next)(skein_stream stream, skein_result* out, skein_error error);
  bool (*stream_free)(skein_stream stream, skein_error error);
  bool (*provider_new)(skein_entity entity, skein_interface interface,
                       const skein_service_options* options,
                       const skein_service_callbacks* callbacks, skein_provider* out,
                       skein_error error);
  bool (*provider_identity)(skein_provider provider, uint8_t out[16], skein_error error);
  bool (*provider_free)(skein_provider provider, skein_error error);
  bool (*reply_answer)(skein_reply reply, skein_value result, skein_error error);
  bool (*reply_fail)(skein_reply reply, skein_error_kind kind, const char* text, skein_error error);
  bool (*reply_raise)(skein_reply reply, const char* exception, skein_value members,
                      skein_error error);
  bool (*reply_push)(skein_reply reply, skein_value item, bool* sent, skein_error error);
  bool (*reply_cancelled)(skein_reply reply, bool* out, skein_error error);
  bool (*reply_time_left)(skein_reply reply, int64_t* out_ns, skein_error error);
  bool (*reply_on_cancel)(skein_reply reply, const skein_cancel_callbacks* callbacks,
                          skein_error error);
  bool (*reply_free)(skein_reply reply, skein_error error);
  bool (*publisher_new)(skein_entity entity, skein_interface types, const char* type,
                        const char* topic, const skein_topic_options* options, skein_publisher* out,
                        skein_error error);
  bool (*publisher_publish)(skein_publisher publisher, skein_value value, skein_error error);
  bool (*publisher_subscribers)(skein_publisher publisher, size_t* out, skein_error error);
  bool (*publisher_wait)(skein_publisher publisher, int64_t timeout_ns, bool* acknowledged,
                         skein_error error);
  bool (*publisher_free)(skein_publisher publisher, skein_error error);
  bool (*subscription_new)(skein_entity entity, skein_interface types, const char* type,
                           const char* topic, const skein_topic_options* options,
                           const skein_subscription_callbacks* callbacks, skein_subscription* out,
                           skein_error error);
  bool (*subscription_publishers)(skein_subscription subscription, size_t* out, skein_error error);
  bool (*subscription_free)(skein_subscription subscription, skein_error error);
  bool (*entity_perform)(skein_entity entity, skein_interface interface, const skein_task* task,
                         const skein_task_callbacks* callbacks, skein_result* out,
                         skein_result* decision, skein_error error);
  bool (*log_write)(skein_log_level level, const char* place, const char* text, skein_error error);
  bool (*log_set_level)(skein_log_level least, skein_error error);
  bool (*log_set_sink)(const skein_log_callbacks* callbacks, skein_error error);
  bool (*signal_wait)(int32_t* out, skein_error error);
} skein_api;

/* The table, with all that the version has; NULL if the library does not have that version. It is
 * valid until the process ends. */
const skein_api* skein_api_of(uint32_t version);

#ifdef __cplusplus
}
#endif

#endif
