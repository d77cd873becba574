# liana_embed_shaders(target folder): every shader of the folder becomes text inside the target, so the program runs
# from any place. Read back with shader_source("name.frag").
function(liana_embed_shaders target folder)
  file(GLOB shaders CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.vert ${PROJECT_SOURCE_DIR}/${folder}/*.frag
       ${PROJECT_SOURCE_DIR}/${folder}/*.glsl)
  set(output ${PROJECT_BINARY_DIR}/shader_sources.cpp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} "-DSHADERS=${shaders}" -P ${PROJECT_SOURCE_DIR}/cmake/embed_shaders_script.cmake
    DEPENDS ${shaders} ${PROJECT_SOURCE_DIR}/cmake/embed_shaders_script.cmake
    COMMENT "Embedding shaders" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
