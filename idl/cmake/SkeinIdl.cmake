# skein_add_idl(TARGET target FILES a.idl … [INCLUDES folder …] [NAMESPACE name] [C])
#
# Compiles IDL for a target: adds the generated sources to it and the folder of the generated headers to its public
# include folders (a.idl becomes a.idl.hpp). The flattened IDL for DDS without Skein (a.dds.idl) lies beside them, in the folder
# that the target's property SKEIN_IDL_DIRECTORY names. A file below one of INCLUDES keeps its path from there: with
# INCLUDES idl, idl/geo/point.idl becomes geo/point.idl.hpp. NAMESPACE puts all C++ names into a namespace, also those of included files, which must be
# compiled with the same. Outputs are made anew when the file, what it includes, or the compiler changes. A file that another rule makes is named to CMake
# before. With C, the code is C (a.idl.h and a.idl.c), and the target links skein::c. The target links Skein itself. Its code is made position-independent, so that a plugin can link it.
#
# The same in Skein's own tree, in an installed package, and in a project that adds the tree by FetchContent or add_subdirectory.
get_filename_component(SKEIN_IDL_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
# The system's Python, which has its packages, whatever else comes first in PATH.
find_program(SKEIN_IDL_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH DOC "Python with the package lark (Debian: python3-lark)")

function(skein_add_idl)
  cmake_parse_arguments(PARSE_ARGV 0 IDL "C" "TARGET;NAMESPACE" "FILES;INCLUDES")
  # By DEFINED: as values, names like `n`, `no` and `off` are false.
  if(DEFINED IDL_UNPARSED_ARGUMENTS OR NOT DEFINED IDL_TARGET OR NOT DEFINED IDL_FILES)
    message(FATAL_ERROR "skein_add_idl(TARGET target FILES a.idl … [INCLUDES folder …] [NAMESPACE name]): wrong arguments '${ARGN}'")
  endif()
  if(TARGET ${IDL_TARGET}_generated)
    message(FATAL_ERROR "skein_add_idl: the target '${IDL_TARGET}' has its IDL from an earlier call; name all of its files in one call, behind FILES")
  endif()
  _skein_idl_check_target(${IDL_TARGET})
  _skein_idl_require_lark()
  # Of this file, not of the caller's scope: a project that adds Skein by add_subdirectory has no variable of Skein's.
  cmake_path(SET compiler NORMALIZE "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../compiler")
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/${IDL_TARGET}.idl)
  set(outputs)
  set(includes)
  set(flags)
  set(header hpp)
  set(source cpp)
  if(IDL_C)
    set(flags --language c)
    set(header h)
    set(source c)
  endif()
  if(DEFINED IDL_NAMESPACE)
    list(APPEND flags --namespace ${IDL_NAMESPACE})
  endif()
  foreach(folder IN LISTS IDL_INCLUDES)
    get_filename_component(folder ${folder} ABSOLUTE)
    list(APPEND includes ${folder})
    list(APPEND flags -I${folder})
  endforeach()
  foreach(file IN LISTS IDL_FILES)
    get_filename_component(path ${file} ABSOLUTE)
    _skein_idl_check_file(${path})
    _skein_idl_name(name ${path} "${includes}")
    set(output ${directory}/${name})
    string(REGEX REPLACE "\\.idl$" ".dds.idl" flattened ${output})
    get_filename_component(folder ${output} DIRECTORY)
    file(MAKE_DIRECTORY ${folder})
    add_custom_command(
      OUTPUT ${flattened} ${output}.${header} ${output}.${source}  # the first is always written; the others, if they differ
      COMMAND ${SKEIN_IDL_PYTHON} -B ${compiler} ${flags} --out ${directory} --depfile ${output}.d ${path}
      DEPENDS ${path}
      DEPFILE ${output}.d
      COMMENT "IDL ${name}"
      VERBATIM)
    target_sources(${IDL_TARGET} PRIVATE ${output}.${source} ${output}.${header})
    list(APPEND outputs ${output}.${header})
  endforeach()
  # skein_generated makes all generated headers and nothing else: for tools that read sources.
  if(NOT TARGET skein_generated)
    add_custom_target(skein_generated)
  endif()
  add_custom_target(${IDL_TARGET}_generated DEPENDS ${outputs})
  add_dependencies(skein_generated ${IDL_TARGET}_generated)
  target_include_directories(${IDL_TARGET} PUBLIC $<BUILD_INTERFACE:${directory}>)
  set_target_properties(${IDL_TARGET} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  set_property(TARGET ${IDL_TARGET} PROPERTY SKEIN_IDL_DIRECTORY ${directory})
endfunction()

# The generated sources are compiled for the target.
function(_skein_idl_check_target target)
  if(NOT TARGET ${target})
    message(FATAL_ERROR "skein_add_idl: there is no target '${target}'; add it before, as in add_library(${target} STATIC)")
  endif()
  get_target_property(type ${target} TYPE)
  get_target_property(alias ${target} ALIASED_TARGET)
  get_target_property(imported ${target} IMPORTED)
  if(NOT alias STREQUAL "alias-NOTFOUND" OR imported OR type STREQUAL INTERFACE_LIBRARY OR type STREQUAL UTILITY)
    message(FATAL_ERROR "skein_add_idl: the generated code is compiled for its target, and '${target}' has no code of its own; "
      "name a target that has, as add_library(NAME STATIC), and link it to '${target}'")
  endif()
endfunction()

function(_skein_idl_check_file path)
  get_source_file_property(generated ${path} GENERATED)
  if(NOT EXISTS ${path} AND NOT generated)
    get_filename_component(folder ${path} DIRECTORY)
    get_filename_component(name ${path} NAME)
    file(GLOB there RELATIVE ${folder} ${folder}/*.idl)
    list(JOIN there ", " there)
    message(FATAL_ERROR "skein_add_idl: there is no file '${name}' in ${folder}, which has these: ${there}")
  endif()
endfunction()

function(_skein_idl_require_lark)
  get_property(found GLOBAL PROPERTY SKEIN_IDL_HAS_LARK)
  if(NOT found)
    execute_process(COMMAND ${SKEIN_IDL_PYTHON} -c "import lark" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(NOT SKEIN_IDL_PYTHON OR failed)
      message(FATAL_ERROR "skein_add_idl needs the system's Python with lark, which was not found: apt-get install python3-lark")
    endif()
    set_property(GLOBAL PROPERTY SKEIN_IDL_HAS_LARK TRUE)
  endif()
endfunction()

# A file's path from the first include folder that holds it, else its last part.
function(_skein_idl_name variable path includes)
  get_filename_component(name ${path} NAME)
  foreach(folder IN LISTS includes)
    cmake_path(IS_PREFIX folder ${path} NORMALIZE inside)
    if(inside)
      file(RELATIVE_PATH name ${folder} ${path})
      break()
    endif()
  endforeach()
  set(${variable} ${name} PARENT_SCOPE)
endfunction()
