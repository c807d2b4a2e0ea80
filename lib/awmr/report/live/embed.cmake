# Compresses ${WASM} and writes it as text into the source ${OUTPUT}. The compressed file has no
# name and time, so that the bytes are reproducible.
execute_process(COMMAND ${GZIP} -9nc ${WASM} COMMAND ${BASE64} -w0 OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${OUTPUT} "#include <string_view>\nnamespace awmr {\nextern const std::string_view kLiveWasm;\n"
  "const std::string_view kLiveWasm = R\"awmr~(${text})awmr~\";\n}  // namespace awmr\n")
