# Builds the interactive part of the page: simulation and constraints are compiled to WebAssembly,
# compressed and written as text into ${AWMR_LIVE_SOURCE}. If AWMR_LIVE_PAGE is off or the toolchain is
# missing, the text is empty, and the page reports that it has no sliders.
set(live_directory ${CMAKE_CURRENT_BINARY_DIR}/live)
set(AWMR_LIVE_SOURCE ${live_directory}/live_wasm.cpp)
file(MAKE_DIRECTORY ${live_directory})

find_program(AWMR_WASM_CXX clang++)
find_program(AWMR_WASM_LD wasm-ld)
find_program(AWMR_GZIP gzip)
find_program(AWMR_BASE64 base64)
set(works 1)
option(AWMR_LIVE_PAGE "Compile the simulation into the report, for its sliders (clang, lld and wasi-libc)" ON)
if(AWMR_LIVE_PAGE AND AWMR_WASM_CXX AND AWMR_WASM_LD AND AWMR_GZIP AND AWMR_BASE64)
  file(WRITE ${live_directory}/try.cpp "#include <cmath>\n#include <vector>\nint main() {}\n")
  execute_process(COMMAND ${AWMR_WASM_CXX} --target=wasm32-wasi -std=c++20 try.cpp -o try.wasm
    WORKING_DIRECTORY ${live_directory} RESULT_VARIABLE works OUTPUT_QUIET ERROR_QUIET)
endif()
if(NOT works EQUAL 0)
  message(STATUS "report: built without sliders (AWMR_LIVE_PAGE is off, or clang, lld or wasi-libc is missing: scripts/setup all)")
  file(WRITE ${AWMR_LIVE_SOURCE} "#include <string_view>\nnamespace awmr {\nextern const std::string_view kLiveWasm;\n"
    "const std::string_view kLiveWasm;\n}  // namespace awmr\n")
  return()
endif()

# Flags of both objects. -ffp-contract=off as in the whole project; -fno-exceptions because these
# sources throw no exceptions.
set(flags --target=wasm32-wasi -std=c++20 -Oz -ffp-contract=off -ffunction-sections -fno-exceptions -fno-rtti -DNDEBUG
  -DFMT_HEADER_ONLY -isystem /usr/include/eigen3 -I${PROJECT_SOURCE_DIR}/lib)
set(text "")
foreach(part core/error core/statistics/linear_algebra core/option_text core/text model/family model/model model/observer_rate
    model/parameters model/rest_speed model/vehicle simulate/disturbance simulate/metrics
    simulate/passage simulate/physics simulate/run_columns simulate/scenario_guidance simulate/scenario
    simulate/sensing simulate/simulate
    tune/constraints tune/sampled_loop tune/steering_rate report/live/live)
  string(APPEND text "#include \"${PROJECT_SOURCE_DIR}/lib/awmr/${part}.cpp\"\n")
endforeach()
file(CONFIGURE OUTPUT ${live_directory}/simulation.cpp CONTENT "${text}")
set(objects)
foreach(source ${live_directory}/simulation.cpp ${PROJECT_SOURCE_DIR}/lib/awmr/core/random.cpp)
  get_filename_component(name ${source} NAME_WE)
  set(object ${live_directory}/${name}.o)
  set(more)
  if(name STREQUAL random)
    # Random123 does not support wasm32, but its code for small ARM processors works. Its arrays contain throw
    # statements that are never reached.
    set(more -fexceptions -fignore-exceptions -D__arm__)
  endif()
  add_custom_command(OUTPUT ${object} DEPENDS ${source} DEPFILE ${object}.d
    COMMAND ${CMAKE_CXX_COMPILER_LAUNCHER} ${AWMR_WASM_CXX} ${flags} ${more} -MD -MF ${object}.d -c ${source} -o ${object}
    COMMENT "Compiling ${name}.cpp to WebAssembly" VERBATIM)
  list(APPEND objects ${object})
endforeach()
set(wasm ${live_directory}/live.wasm)
add_custom_command(OUTPUT ${AWMR_LIVE_SOURCE} DEPENDS ${objects} ${CMAKE_CURRENT_LIST_DIR}/embed.cmake
  COMMAND ${AWMR_WASM_CXX} --target=wasm32-wasi -mexec-model=reactor -Wl,--gc-sections -Wl,--strip-all ${objects} -o ${wasm}
  COMMAND ${CMAKE_COMMAND} -DWASM=${wasm} -DGZIP=${AWMR_GZIP} -DBASE64=${AWMR_BASE64} -DOUTPUT=${AWMR_LIVE_SOURCE}
    -P ${CMAKE_CURRENT_LIST_DIR}/embed.cmake
  COMMENT "Linking the report's live part" VERBATIM)
