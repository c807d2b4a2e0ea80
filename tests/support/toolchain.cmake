# awmr_use_toolchain(TARGET): passes the paths of the compilers that a test runs as defines. A
# missing one is "…-NOTFOUND"; the test then fails with a message (tests/support/toolchain.h).
function(awmr_use_toolchain target)
  foreach(program ccache gcc g++ clang clang++ objcopy avr-gcc avr-g++ avr-objcopy avr-size avr-gcc-ar
          arm-none-eabi-gcc arm-none-eabi-g++ qemu-system-arm)
    string(TOUPPER "AWMR_TOOL_${program}" variable)
    string(REPLACE "++" "XX" variable ${variable})
    string(REPLACE "-" "_" variable ${variable})
    find_program(${variable} ${program})
    mark_as_advanced(${variable})
    target_compile_definitions(${target} PRIVATE ${variable}="${${variable}}")
  endforeach()
endfunction()
