# Compiler warnings, as a target that every target of this project links privately. It is not exported, so that users of the
# library do not get the warnings.
add_library(awmr_warnings INTERFACE)
if(AWMR_WARNINGS)
  target_compile_options(awmr_warnings INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
    -Wold-style-cast -Woverloaded-virtual -Wdouble-promotion
    $<$<BOOL:${AWMR_WARNINGS_AS_ERRORS}>:-Werror>)
else()
  # Without warnings, the compiler does not check fmt's format strings either, which takes a tenth of the compile time.
  add_compile_definitions(FMT_CONSTEVAL=)
endif()

# awmr_library(NAME HEADERS file... [SOURCES file...] [PUBLIC target...] [PRIVATE target...])
# Defines the library of one folder, `awmr_NAME` with the alias `awmr::NAME`; header-only without SOURCES. HEADERS are the
# public headers; only these are installed.
function(awmr_library name)
  cmake_parse_arguments(ARG "" "" "HEADERS;SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target awmr_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    target_link_libraries(${target} PUBLIC ${ARG_PUBLIC}
      PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:awmr_warnings>)
    set(scope PUBLIC)
    # No contraction of products and sums into fused multiply-add, so that every compiler gives the same results.
    target_compile_options(${target} PRIVATE -ffp-contract=off)
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${ARG_PUBLIC})
    set(scope INTERFACE)
  endif()
  add_library(awmr::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/lib> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/lib
    FILES ${ARG_HEADERS})
  target_compile_features(${target} ${scope} cxx_std_20)
  set_property(GLOBAL APPEND PROPERTY AWMR_LIBRARIES ${target})
endfunction()

# The linker gold takes a quarter of the default linker's time for a test. Debian 12's binutils contains gold, newer ones may not.
include(CheckLinkerFlag)
check_linker_flag(CXX -fuse-ld=gold AWMR_HAS_GOLD)

# awmr_test(NAME SOURCES file... [TIER tier] [LINK target...] [CASES n] [COST n] [TOGETHER suite...]): one GoogleTest executable.
# Each test case is a test of CTest, except that each suite in TOGETHER is one test, because its cases share a costly set-up.
# RapidCheck's properties have a fixed seed and n random cases, 100 by default. TIER is `unit` by default (tests/README.md). Instances
# of value-parameterised suites that are named Long are in tier `long`; those named Short detect the same defects with fewer repeats.
# CTest starts tests with a larger COST first, so that the last ones to run are short.
function(awmr_test name)
  cmake_parse_arguments(ARG "" "CASES;COST;TIER" "SOURCES;LINK;TOGETHER" ${ARGN})
  if(NOT ARG_CASES)
    set(ARG_CASES 100)
  endif()
  if(NOT ARG_TIER)
    set(ARG_TIER unit)
  endif()
  if(NOT ARG_COST)
    set(ARG_COST 0)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  # -O1 shortens the compile time. With it GCC 12 gives false warnings of overflows, which are disabled.
  target_compile_options(${name} PRIVATE -ffp-contract=off $<$<CONFIG:Release>:-O1>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-stringop-overflow>)
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gmock GTest::gtest_main awmr_warnings)
  target_link_options(${name} PRIVATE $<$<BOOL:${AWMR_HAS_GOLD}>:-fuse-ld=gold>)
  target_precompile_headers(${name} REUSE_FROM awmr_test_headers)
  target_compile_definitions(${name} PRIVATE AWMR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  set(others "-Long/*")
  if(ARG_TOGETHER)
    list(TRANSFORM ARG_TOGETHER APPEND ".*" OUTPUT_VARIABLE suites)
    list(JOIN suites ":" suites)
    string(APPEND others ":${suites}")
    foreach(suite IN LISTS ARG_TOGETHER)
      awmr_command_test(${suite} TIER ${ARG_TIER} TIMEOUT 300 COMMAND ${name} --gtest_filter=${suite}.*)
    endforeach()
  endif()
  set(properties TIMEOUT 300 COST ${ARG_COST} ENVIRONMENT "RC_PARAMS=seed=20260117 max_success=${ARG_CASES}")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_FILTER "${others}" PROPERTIES ${properties} LABELS ${ARG_TIER})
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_FILTER "Long/*" TEST_LIST ${name}_long PROPERTIES ${properties} LABELS long)
endfunction()

# awmr_command_test(NAME TIER tier TIMEOUT seconds COMMAND word... [NEEDS package=variable...]): a test that runs a command, whose
# exit code 77 means "skipped". If a variable of NEEDS is false, the test is skipped and names the missing package. CTest
# starts these tests before the cases of awmr_test(), because they take longer (COST).
function(awmr_command_test name)
  cmake_parse_arguments(ARG "" "TIER;TIMEOUT" "COMMAND;NEEDS" ${ARGN})
  foreach(need IN LISTS ARG_NEEDS)
    string(REGEX MATCH "^([^=]+)=(.+)$" matched ${need})
    if(NOT ${CMAKE_MATCH_2})
      set(ARG_COMMAND ${CMAKE_COMMAND} -E echo "skipped: ${CMAKE_MATCH_1} is not installed (scripts/setup all)")
      break()
    endif()
  endforeach()
  add_test(NAME ${name} COMMAND ${ARG_COMMAND})
  set_tests_properties(${name} PROPERTIES LABELS ${ARG_TIER} TIMEOUT ${ARG_TIMEOUT} SKIP_RETURN_CODE 77 COST ${ARG_TIMEOUT}
    SKIP_REGULAR_EXPRESSION "^skipped: ")
endfunction()
