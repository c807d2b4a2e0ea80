# What the compiler and the linker offer against memory errors, on by default for this project's own builds: canaries on
# the stack, checked string functions, position independence, and a table of addresses that is read-only at run time.
option(AWMR_HARDENING "Build with stack protector, FORTIFY, PIE and RELRO" ${PROJECT_IS_TOP_LEVEL})
if(AWMR_HARDENING)
  include(CheckPIESupported)
  check_pie_supported(LANGUAGES CXX)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  add_compile_options(-fstack-protector-strong)
  # FORTIFY needs optimisation, and the address sanitizer replaces the functions that it would check.
  if(NOT CMAKE_BUILD_TYPE STREQUAL Debug AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    add_compile_options(-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
  endif()
  add_link_options(-Wl,-z,relro,-z,now,-z,noexecstack)
endif()
