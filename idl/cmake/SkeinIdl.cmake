# skein_add_idl(TARGET target FILES a.idl … [INCLUDES folder …])
#
# Compiles IDL for a target: adds the generated sources to it and the folder of the generated headers to its public
# include folders (a.idl becomes a.idl.hpp). The flattened IDL for DDS without Skein (a.dds.idl) lies beside them, in the folder
# that the target's property SKEIN_IDL_DIRECTORY names. A file below one of INCLUDES keeps its path from there: with
# INCLUDES idl, idl/geo/point.idl becomes geo/point.idl.hpp. Outputs are made anew when the file, what it includes, or
# the compiler changes. The target links Skein itself. Its code is made position-independent, so that a plugin can link it.
#
# The same in Skein's own tree and in an installed package.
get_filename_component(SKEIN_IDL_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
find_program(SKEIN_OMNIIDL omniidl DOC "OMG IDL front end (Debian package omniidl)")

function(skein_add_idl)
  cmake_parse_arguments(PARSE_ARGV 0 IDL "" "TARGET" "FILES;INCLUDES")
  if(IDL_UNPARSED_ARGUMENTS OR NOT IDL_TARGET OR NOT IDL_FILES)
    message(FATAL_ERROR "skein_add_idl(TARGET target FILES a.idl … [INCLUDES folder …]): wrong arguments '${ARGN}'")
  endif()
  if(NOT SKEIN_OMNIIDL)
    message(FATAL_ERROR "skein_add_idl needs omniidl, which was not found: apt-get install omniidl")
  endif()
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/${IDL_TARGET}.idl)
  set(outputs)
  set(includes)
  set(flags -I${SKEIN_IDL_ROOT}/skein)
  foreach(folder IN LISTS IDL_INCLUDES)
    get_filename_component(folder ${folder} ABSOLUTE)
    list(APPEND includes ${folder})
    list(APPEND flags -I${folder})
  endforeach()
  foreach(file IN LISTS IDL_FILES)
    get_filename_component(path ${file} ABSOLUTE)
    _skein_idl_name(name ${path} "${includes}")
    set(output ${directory}/${name})
    string(REGEX REPLACE "\\.idl$" ".dds.idl" flattened ${output})
    get_filename_component(folder ${output} DIRECTORY)
    file(MAKE_DIRECTORY ${folder})
    add_custom_command(
      OUTPUT ${output}.hpp ${output}.cpp ${flattened}
      COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 ${SKEIN_OMNIIDL} -p${SKEIN_IDL_ROOT}/compiler -bskein
              ${flags} -Wbdirectory=${directory},name=${name},depfile=${output}.d ${path}
      DEPENDS ${path}
      DEPFILE ${output}.d
      COMMENT "IDL ${name}"
      VERBATIM)
    target_sources(${IDL_TARGET} PRIVATE ${output}.cpp ${output}.hpp)
    list(APPEND outputs ${output}.hpp)
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
