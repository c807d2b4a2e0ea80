# Protections of compiler and linker against memory errors, on by default unless another project includes this one: canaries on
# the stack, string functions with checked lengths (FORTIFY), position-independent code, and an address table (GOT) that is
# read-only at run time.
option(AWMR_HARDENING "Build with stack protector, FORTIFY, PIE and RELRO" ${PROJECT_IS_TOP_LEVEL})
if(AWMR_HARDENING)
  include(CheckPIESupported)
  check_pie_supported(LANGUAGES CXX)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  add_compile_options(-fstack-protector-strong)
  # FORTIFY works only in optimised builds. The address sanitizer replaces the same functions, so they are not combined.
  if(NOT CMAKE_BUILD_TYPE STREQUAL Debug AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    add_compile_options(-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
  endif()
  add_link_options(-Wl,-z,relro,-z,now,-z,noexecstack)
endif()
