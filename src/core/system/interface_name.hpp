#pragma once

#include <string>
#include <string_view>

namespace skein {

/// The one spelling of an interface's name that Skein compares, stores and sends, which is also
/// that of InterfaceInfo::name: `AE_navigator/IPlanner`.
///
/// `IDL:AE_navigator/IPlanner`, `IDL:AE_navigator/IPlanner:1.0`, `AE_navigator/IPlanner`,
/// `AE_navigator::IPlanner` and `::AE_navigator::IPlanner` are the same interface, and so are these
/// with white space around them (component descriptions are printed with line breaks inside their
/// text). The version of a repository id is dropped: whether two versions understand each other is
/// told by their operations, not by their names.
///
/// Throws InvalidArgument for what is no interface name: empty text, or a part that is no
/// identifier. A pure function, callable from any thread; so are the others here.
std::string canonical_interface_name(std::string_view name);

/// Whether canonical_interface_name() accepts `name`.
bool is_interface_name(std::string_view name) noexcept;

/// Whether two spellings name the same interface. Throws as canonical_interface_name() does.
bool same_interface(std::string_view left, std::string_view right);

/// The last part of a name: `IPlanner` for every spelling of `AE_navigator/IPlanner`. It is not
/// unique: two modules may hold an interface of the same short name.
/// Throws as canonical_interface_name() does.
std::string short_interface_name(std::string_view name);

/// Whether the interface, by its canonical name, is one that Skein itself provides beside an
/// entity's own: who names the entity does not mean it.
bool is_built_in_interface(std::string_view canonical_name) noexcept;

/// The C++ and IDL spelling: `AE_navigator::IPlanner`. Throws as canonical_interface_name() does.
std::string scoped_interface_name(std::string_view name);

}  // namespace skein
