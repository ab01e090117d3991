# cmake -D BUILD=folder -D PREFIX=folder [-D NINJA=program] -P install_and_move.cmake: nothing in the package may remember where it was
# installed.
set(first ${PREFIX}.first)
file(REMOVE_RECURSE ${first} ${PREFIX})
# After a build of some targets only an installation builds the rest: this file stands for what is missing then,
file(REMOVE ${BUILD}/src/command/completion/skein.fish)
# and all libraries and programs that are installed are of the target that it builds.
if(NINJA)
  execute_process(COMMAND ${NINJA} -C ${BUILD} -t commands skein_package OUTPUT_VARIABLE commands COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB scripts ${BUILD}/src/cmake_install.cmake ${BUILD}/src/*/cmake_install.cmake ${BUILD}/src/*/*/cmake_install.cmake
    ${BUILD}/examples/*/cmake_install.cmake)
  foreach(script IN LISTS scripts)
    file(READ ${script} text)
    string(REGEX MATCHALL "\"${BUILD}/(bin|lib)/[^\"]+" files "${text}")
    foreach(file IN LISTS files)
      string(REPLACE "\"${BUILD}/" "" file ${file})
      string(FIND "${commands}" ${file} at)
      if(at EQUAL -1)
        message(SEND_ERROR "${file} is installed, but not of the target skein_package")
      endif()
    endforeach()
  endforeach()
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${first} COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${first} ${PREFIX})
# Headers lie in folders of Skein's own: those of the system share this one.
file(GLOB in_include RELATIVE ${PREFIX}/include ${PREFIX}/include/*)
if(NOT in_include STREQUAL "skein;skein-navigation")
  message(SEND_ERROR "include/ has ${in_include}; only the folders skein and skein-navigation belong there")
endif()
file(GLOB_RECURSE texts ${PREFIX}/*.cmake ${PREFIX}/*.hpp ${PREFIX}/*.xml ${PREFIX}/*.idl ${PREFIX}/*.py)
foreach(file IN LISTS texts)
  file(READ ${file} text)
  foreach(folder ${first} ${BUILD})
    string(FIND "${text}" ${folder} at)
    if(at GREATER -1)
      message(SEND_ERROR "${file} names ${folder}")
    endif()
  endforeach()
endforeach()
foreach(file share/doc/skein/README.md share/doc/skein/GUIDE.md share/doc/skein/TROUBLESHOOTING.md
    share/doc/skein/ARCHITECTURE.md share/doc/skein/CHANGELOG.md share/doc/skein/LICENSE
    share/doc/skein/examples/01_first_service/provider.cpp share/doc/skein/test/guide/survey.idl share/man/man1/skein.1
    share/man/man1/skein-launch.1 share/bash-completion/completions/skein
    share/zsh/site-functions/_skein share/fish/vendor_completions.d/skein.fish)
  if(NOT EXISTS ${PREFIX}/${file})
    message(SEND_ERROR "${file} is not installed")
  endif()
endforeach()
