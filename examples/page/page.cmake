# add_page(target namespace body script): gives a target NAMESPACE::page_of(json), a page that a script inside of it draws
# from a record in JSON. The style and chart.js, what all scripts draw with, are here; body and script are the target's.
set(page_folder ${CMAKE_CURRENT_LIST_DIR})
function(add_page target page_namespace body script)
  file(READ ${page_folder}/page.css page_style)
  file(READ ${page_folder}/chart.js chart)
  file(READ ${body} page_body)
  file(READ ${script} page_script)
  string(PREPEND page_script "${chart}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page_folder}/page.css ${page_folder}/chart.js ${body} ${script})
  configure_file(${page_folder}/page.cpp.in ${target}_page.cpp @ONLY)
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${target}_page.cpp)
endfunction()
