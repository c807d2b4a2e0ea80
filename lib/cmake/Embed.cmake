# awmr_embed(NAME OUTPUT HEADER FILES path=source...): writes OUTPUT, a C++ source that defines the function declared in HEADER,
#   const std::vector<EmbeddedFile>& NAME();
# It returns the text of the files, in this order, each under its path. The texts are string literals: the standard guarantees
# only 64 KiB each, but GCC and Clang accept any length.
function(awmr_embed name output header)
  cmake_parse_arguments(ARG "" "" "FILES" ${ARGN})
  set(entries)
  foreach(entry IN LISTS ARG_FILES)
    string(REGEX MATCH "^([^=]+)=(.+)$" matched "${entry}")
    set(path ${CMAKE_MATCH_1})
    set(source ${CMAKE_MATCH_2})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(READ ${source} text)
    string(APPEND entries "    {\"${path}\", R\"awmr~(${text})awmr~\"},\n")
  endforeach()
  file(CONFIGURE OUTPUT ${output} @ONLY CONTENT
    "#include \"${header}\"\nnamespace awmr {\nconst std::vector<EmbeddedFile>& ${name}() {\n  static const std::vector<EmbeddedFile> files{\n@entries@  };\n  return files;\n}\n}  // namespace awmr\n")
endfunction()
