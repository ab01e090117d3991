#include <cstdint>

#include "skein/c/api.h"

namespace {

constexpr skein_api kApi{
    .version = SKEIN_API_VERSION,
    .error_new = skein_error_new,
    .error_free = skein_error_free,
    .error_class = skein_error_class,
    .error_text = skein_error_text,
    .error_exception = skein_error_exception,
    .error_clear = skein_error_clear,
    .error_set = skein_error_set,
    .result_value = skein_result_value,
    .result_free = skein_result_free,
    .entity_new = skein_entity_new,
    .entity_free = skein_entity_free,
    .entity_id = skein_entity_id,
    .entity_drain = skein_entity_drain,
    .interface_new = skein_interface_new,
    .interface_fetch = skein_interface_fetch,
    .interface_fetch_topic = skein_interface_fetch_topic,
    .interface_name = skein_interface_name,
    .interface_describe = skein_interface_describe,
    .interface_example = skein_interface_example,
    .interface_convert = skein_interface_convert,
    .interface_free = skein_interface_free,
    .proxy_connect = skein_proxy_connect,
    .proxy_connected = skein_proxy_connected,
    .proxy_free = skein_proxy_free,
    .proxy_call = skein_proxy_call,
    .proxy_start = skein_proxy_start,
    .call_wait = skein_call_wait,
    .call_cancel = skein_call_cancel,
    .call_free = skein_call_free,
    .proxy_stream = skein_proxy_stream,
    .stream_next = skein_stream_next,
    .stream_free = skein_stream_free,
    .provider_new = skein_provider_new,
    .provider_identity = skein_provider_identity,
    .provider_free = skein_provider_free,
    .reply_answer = skein_reply_answer,
    .reply_fail = skein_reply_fail,
    .reply_raise = skein_reply_raise,
    .reply_push = skein_reply_push,
    .reply_cancelled = skein_reply_cancelled,
    .reply_time_left = skein_reply_time_left,
    .reply_on_cancel = skein_reply_on_cancel,
    .reply_free = skein_reply_free,
    .publisher_new = skein_publisher_new,
    .publisher_publish = skein_publisher_publish,
    .publisher_subscribers = skein_publisher_subscribers,
    .publisher_wait = skein_publisher_wait,
    .publisher_free = skein_publisher_free,
    .subscription_new = skein_subscription_new,
    .subscription_publishers = skein_subscription_publishers,
    .subscription_free = skein_subscription_free,
    .entity_perform = skein_entity_perform,
    .log_write = skein_log_write,
    .log_set_level = skein_log_set_level,
    .log_set_sink = skein_log_set_sink,
    .signal_wait = skein_signal_wait,
};

}  // namespace

const skein_api* skein_api_of(std::uint32_t version) {
  return version > 0 && version <= SKEIN_API_VERSION ? &kApi : nullptr;
}
