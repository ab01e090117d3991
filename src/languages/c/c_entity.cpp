#include <utility>

#include "objects.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace skein::c;

namespace {

std::vector<std::string> texts_of(const char* const* texts, std::size_t size, const char* what) {
  if (size > 0) demand(texts, what);
  std::vector<std::string> all;
  for (std::size_t i = 0; i < size; ++i) all.push_back(text_of(texts[i], what));
  return all;
}

EntityOptions entity_options_of(const skein_entity_options& given) {
  check_reserved(given.reserved);
  EntityOptions options;
  options.name = text_of(given.name, "the entity's name");
  if (given.system) options.system = given.system;
  options.vendor = dds::load_vendor(text_of(given.vendor, "the entity's vendor"));
  options.domain = given.domain;
  options.network.interfaces = texts_of(given.network, given.network_size, "a network interface");
  options.network.peers = texts_of(given.peers, given.peers_size, "a peer");
  options.network.multicast_discovery = given.multicast;
  if (given.no_shared_memory_calls) options.shared_memory_calls = false;
  options.lease = std::chrono::ceil<std::chrono::milliseconds>(
      time_of(given.lease_ns, "lease_ns", options.lease));
  return options;
}

/// The entities of one process call each other within it.
const std::shared_ptr<Process>& process() {
  static const auto& process = *new auto(std::make_shared<Process>());
  return process;
}

}  // namespace

bool skein_entity_new(const skein_entity_options* options, skein_entity* out, skein_error error) {
  return attempt(error, [&] {
    demand(options, "options");
    demand(out, "out");
    EntityOptions made = entity_options_of(*options);
    made.process = process();
    const auto object = std::make_shared<EntityObject>(std::make_unique<Entity>(std::move(made)));
    *out = add(object);
  });
}

bool skein_entity_free(skein_entity entity, skein_error error) {
  return attempt(error, [&] {
    refuse_inside(entity.id, "skein_entity_free");
    const auto object = remove<EntityObject>(entity);
    if (!object) return;
    // Threads that wait for a provider use the entity, and end() would wait for them.
    attempt({}, [&] { object->use()->connector().close(); });
    object->end();
  });
}

bool skein_entity_id(skein_entity entity, const char** out, skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    *out = find<EntityObject>(entity)->id.c_str();
  });
}

bool skein_entity_drain(skein_entity entity, std::int64_t patience_ns, bool* drained,
                        skein_error error) {
  return attempt(error, [&] {
    refuse_inside(entity.id, "skein_entity_drain");
    const auto object = find<EntityObject>(entity);
    const bool done = object->use()->drain(time_of(patience_ns, "patience_ns", Duration::zero()));
    if (drained) *drained = done;
  });
}
