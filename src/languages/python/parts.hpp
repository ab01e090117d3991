#pragma once

#include "interface.hpp"
#include "raising.hpp"

namespace skein::python {

/// A handle of skein.h that functions which wait may go on using when its owner has closed it: they
/// fail then.
struct Entity {
  Owned<skein_entity, skein_entity_free> handle;
};

void define_provider(py::module_& module);
void define_proxy(py::module_& module);
void define_task(py::module_& module);
void define_topics(py::module_& module);

}  // namespace skein::python
