# What `cmake --install` lays down beside the vendors' modules (src/dds) and the IDL compiler (src/idl), and how
# find_package(skein) finds it. Include it after the targets are made.
include(CMakePackageConfigHelpers)

set(skein_package ${CMAKE_INSTALL_LIBDIR}/cmake/skein)

# Users link these, by CMake as skein::skein, skein::c, …, or by pkg-config as skein, skein-c, …
set_target_properties(skein_navigation_idl PROPERTIES EXPORT_NAME navigation_idl)
set_target_properties(skein_fusion PROPERTIES EXPORT_NAME fusion)
set(linked_libraries skein skein_c skein_fusion skein_navigation_idl)
# The others serve the command, or plugins and lie beside these; nobody else links them.
set(plugin_libraries skein_navigation skein_route_checker)
set_target_properties(${linked_libraries} skein_mission ${plugin_libraries} PROPERTIES
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR} INSTALL_RPATH "$ORIGIN")
set_target_properties(${plugin_libraries} PROPERTIES INSTALL_RPATH "$ORIGIN:$ORIGIN/..")

# Names as navigator.idl.hpp are too plain for the folder that everybody's headers share.
set(skein_navigation_idl_subfolder /skein-navigation)
target_include_directories(skein_navigation_idl INTERFACE
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}${skein_navigation_idl_subfolder}>)
install(TARGETS ${linked_libraries} EXPORT skeinTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS skein_mission LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} NAMELINK_SKIP)
install(TARGETS ${plugin_libraries} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/skein NAMELINK_SKIP)
install(EXPORT skeinTargets NAMESPACE skein:: DESTINATION ${skein_package})
set(up /at)
cmake_path(RELATIVE_PATH up BASE_DIRECTORY /at/${CMAKE_INSTALL_LIBDIR}/pkgconfig)
set(skein_fusion_requires skein)
set(skein_navigation_idl_requires skein)
foreach(library IN LISTS linked_libraries)
  string(REPLACE "_" "-" pc ${library})
  set(requires ${${library}_requires})
  set(subfolder ${${library}_subfolder})
  configure_file(${CMAKE_CURRENT_LIST_DIR}/skein.pc.in ${CMAKE_CURRENT_BINARY_DIR}/${pc}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${pc}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/skein DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
foreach(target skein_idl skein_broker skein_rpc skein_entity skein_navigation_idl)
  get_target_property(generated ${target} SKEIN_IDL_DIRECTORY)
  install(DIRECTORY ${generated}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}${${target}_subfolder} FILES_MATCHING PATTERN "*.idl.hpp")
endforeach()

install(FILES ${PROJECT_SOURCE_DIR}/src/dds/valgrind.supp DESTINATION ${CMAKE_INSTALL_DATADIR}/skein)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/idl/navigation DESTINATION ${CMAKE_INSTALL_DATADIR}/skein/idl)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/mission_profiles DESTINATION ${CMAKE_INSTALL_DATADIR}/skein PATTERN README.md EXCLUDE)

# What README and GUIDE point to is installed with them, as far as it can be read without the source tree.
set(source ${PROJECT_SOURCE_DIR})
file(GLOB documents RELATIVE ${source} CONFIGURE_DEPENDS ${source}/examples/[0-9]*/* ${source}/examples/route_planning/*.svg
  ${source}/examples/reconnaissance/*.png
  ${source}/test/guide/*.*)
# Example 06 names files of the profiles beside it.
file(GLOB_RECURSE profiles RELATIVE ${source} CONFIGURE_DEPENDS ${source}/mission_profiles/*.xml)
list(APPEND documents ${profiles} README.md CHANGELOG.md GUIDE.md TROUBLESHOOTING.md ARCHITECTURE.md CONTRIBUTING.md SECURITY.md SHIPPING.md LICENSE benchmarks/README.md brokerless_discovery/RULES.md idl/README.md
  mission_profiles/README.md examples/reconnaissance/README.md examples/route_planning/README.md src/languages/README.md)
list(TRANSFORM documents PREPEND ${source}/ OUTPUT_VARIABLE originals)
set(documents_folder ${CMAKE_CURRENT_BINARY_DIR}/documents)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_custom_command(OUTPUT ${documents_folder}/README.md
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${documents_folder}
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/install_documents.py ${source} ${documents_folder} ${documents}
  DEPENDS ${CMAKE_CURRENT_LIST_DIR}/install_documents.py ${originals} VERBATIM)
add_custom_target(skein_documents ALL DEPENDS ${documents_folder}/README.md)
install(DIRECTORY ${documents_folder}/ DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(skein_idl_function ${CMAKE_INSTALL_DATADIR}/skein/idl/cmake/SkeinIdl.cmake)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/skeinConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/skeinConfig.cmake
  INSTALL_DESTINATION ${skein_package} PATH_VARS skein_idl_function)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/skeinConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/skeinConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/skeinConfigVersion.cmake
  DESTINATION ${skein_package})
