# progiso_embed_shaders(FOLDER TEMPLATE SOURCES HEADERS) embeds every shader below FOLDER as text.
#
# Appends the generated files to the lists named SOURCES and HEADERS. One of them is TEMPLATE, with
# @shader_includes@ and @shader_entries@ replaced: it lists the texts by their paths in FOLDER.
function (progiso_embed_shaders folder template sources_name headers_name)
  file(GLOB_RECURSE shaders CONFIGURE_DEPENDS RELATIVE "${folder}"
    "${folder}/*.glsl" "${folder}/*.glsl.h" "${folder}/*.comp" "${folder}/*.vert" "${folder}/*.frag")
  set(generated_sources)
  set(generated_headers)
  set(shader_includes)
  set(shader_entries)
  foreach (shader IN LISTS shaders)
    string(REGEX REPLACE "[./]" "_" symbol "ProgIso_${shader}")
    vtk_encode_string(
      INPUT         "${folder}/${shader}"
      NAME          "${symbol}"
      HEADER_OUTPUT header
      SOURCE_OUTPUT source)
    list(APPEND generated_sources "${source}")
    list(APPEND generated_headers "${header}")
    string(APPEND shader_includes "#include \"${symbol}.h\"\n")
    string(APPEND shader_entries "    { \"${shader}\", ${symbol} },\n")
  endforeach ()
  get_filename_component(listing "${template}" NAME_WLE)
  configure_file("${template}" "${CMAKE_CURRENT_BINARY_DIR}/${listing}" @ONLY)
  list(APPEND generated_sources "${CMAKE_CURRENT_BINARY_DIR}/${listing}")
  set(${sources_name} ${${sources_name}} ${generated_sources} PARENT_SCOPE)
  set(${headers_name} ${${headers_name}} ${generated_headers} PARENT_SCOPE)
endfunction ()
