# Checks that the sources of types, equations and the closed loop include no header for files, so
# that they compile for targets without a file system. The preprocessor lists their includes.
foreach(source
    core/provenance.h model/vehicle.h model/model.h model/record.h model/vehicle.cpp model/family.cpp
    model/parameters.cpp model/model.cpp control/controller.h control/autopilot.h
    simulate/scenario.h simulate/world.h simulate/simulate.h simulate/metrics.h
    simulate/scenario.cpp simulate/passage.cpp simulate/disturbance.cpp simulate/sensing.cpp
    simulate/physics.cpp simulate/run_columns.cpp simulate/scenario_guidance.cpp simulate/simulate.cpp simulate/metrics.cpp
    trials/trials.h trials/log.h trials/trial_data.h trials/steady.h trials/replay.h
    trials/steady.cpp trials/replay.cpp identify/options.h identify/identify.h
    tune/tune.h tune/tune.cpp compare/compare.h compare/compare.cpp)
  execute_process(COMMAND ${COMPILER} -std=c++20 -I${LIB} -x c++ -M ${LIB}/awmr/${source}
    OUTPUT_VARIABLE included RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${source} cannot be preprocessed")
  endif()
  if(included MATCHES "/(filesystem|fstream)[ \n\\\\]|core/(file|json|csv|input_file)\\.h|_file\\.h|read_trials\\.h")
    message(SEND_ERROR "${source} includes ${CMAKE_MATCH_0}")
  endif()
endforeach()
