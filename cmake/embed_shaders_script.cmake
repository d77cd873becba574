# Run at build time by liana_embed_shaders: SHADERS (a list of files) -> OUTPUT (C++).
set(text "#include \"runtime/view/shader_sources.h\"\n\nnamespace liana {\n\nconst std::vector<ShaderSource> kShaderSources = {\n")
foreach(shader IN LISTS SHADERS)
  get_filename_component(name ${shader} NAME)
  file(READ ${shader} body)
  string(APPEND text "{\"${name}\", R\"GLSL(${body})GLSL\"},\n")
endforeach()
string(APPEND text "};\n\n}  // namespace liana\n")
file(WRITE ${OUTPUT} "${text}")
