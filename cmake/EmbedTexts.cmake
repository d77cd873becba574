# liana_embed_texts(target folder HEADER header LIST "Type name" EXTENSIONS ext ...): the files of a folder become texts
# inside the target, so that the program runs from any place: `const std::vector<Type> name`, which the header declares,
# of {file name, text}.
function(liana_embed_texts target folder)
  cmake_parse_arguments(ARG "" "HEADER;LIST" "EXTENSIONS" ${ARGN})
  set(files)
  foreach(extension IN LISTS ARG_EXTENSIONS)
    file(GLOB found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.${extension})
    list(APPEND files ${found})
  endforeach()
  string(MAKE_C_IDENTIFIER ${folder} name)
  set(output ${PROJECT_BINARY_DIR}/embedded_${name}.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_texts_script.cmake)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} "-DFILES=${files}" -DHEADER=${ARG_HEADER} "-DLIST=${ARG_LIST}" -P ${script}
    DEPENDS ${files} ${script}
    COMMENT "Embedding ${folder}" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
