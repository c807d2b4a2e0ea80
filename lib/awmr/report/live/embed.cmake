# Compresses ${WASM} and writes it as base64 text into the C++ source ${OUTPUT}. The compressed data contain
# no file name and no time, so that the bytes are reproducible.
execute_process(COMMAND ${GZIP} -9nc ${WASM} COMMAND ${BASE64} -w0 OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${OUTPUT} "#include <string_view>\nnamespace awmr {\nextern const std::string_view kLiveWasm;\n"
  "const std::string_view kLiveWasm = R\"awmr~(${text})awmr~\";\n}  // namespace awmr\n")
