# Installs into WORK/prefix, checks the files, builds the README's example with them, runs it on the
# paper's tables and compares its model with the program's. AS_PRINTED: without it, the example's search for gains is nominal.
function(run directory)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${directory} COMMAND_ECHO STDOUT
    OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
  message("${output}")
endfunction()

set(prefix ${WORK}/prefix)
file(REMOVE_RECURSE ${prefix} ${WORK}/consumer ${WORK}/run)
file(MAKE_DIRECTORY ${WORK}/run)
run(${WORK} ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})

# Only public headers may be installed: none that is marked as private or includes an internal library.
file(GLOB_RECURSE headers RELATIVE ${prefix}/include ${prefix}/include/*)
foreach(header IN LISTS headers)
  file(READ ${prefix}/include/${header} text)
  if(NOT header MATCHES "^awmr/.*\\.h$" OR text MATCHES "Private to this folder|Not installed" OR
      text MATCHES "#include <(Eigen|ceres|nlohmann|nlopt|fmt|GeographicLib|CLI)")
    message(FATAL_ERROR "${header} is installed, but is no public header")
  endif()
endforeach()
list(LENGTH headers count)
list(JOIN headers "\n  " listed)
message("${count} headers installed:\n  ${listed}")

run(${WORK} ${CMAKE_COMMAND} -S ${SOURCE}/tests/package/consumer -B ${WORK}/consumer -G Ninja
  -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_PREFIX_PATH=${prefix} -DINCLUDE=${prefix}/include -DAS_PRINTED=${AS_PRINTED} -DREADME=${SOURCE}/lib/awmr/README.md)
run(${WORK} ${CMAKE_COMMAND} --build ${WORK}/consumer)

file(COPY ${SOURCE}/configs/paper/vehicle.json ${SOURCE}/datasets/paper/surge.csv
  ${SOURCE}/datasets/paper/turning.csv ${SOURCE}/datasets/paper/coastdown.csv DESTINATION ${WORK}/run)
run(${WORK}/run ${WORK}/consumer/example)
run(${WORK}/run ${prefix}/bin/awmr identify --vehicle vehicle.json --surge surge.csv --turning turning.csv
  --coastdown coastdown.csv -o program.json)
file(READ ${WORK}/run/model.json ours)
file(READ ${WORK}/run/program.json programs)
foreach(key vehicle surge yaw sway mass_norm inertia_norm steering estimates covariance findings trials)
  string(JSON a GET "${ours}" ${key})
  string(JSON b GET "${programs}" ${key})
  if(NOT a STREQUAL b)
    message(FATAL_ERROR "the example's ${key} is not the program's:\n${a}\n${b}")
  endif()
endforeach()
