# ALHAZEN_INSTRUCTION_SET: the compiler's options for this machine's own instructions, or with ALHAZEN_PORTABLE for
# every x86-64-v3 machine (AVX2; since about 2013). Other processors get what their compiler takes, the portable build its default.
include(CheckCXXCompilerFlag)

set(ALHAZEN_INSTRUCTION_SET "")
if(ALHAZEN_PORTABLE)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    set(ALHAZEN_INSTRUCTION_SET -march=x86-64-v3)
  endif()
elseif(NOT CMAKE_CROSSCOMPILING)
  check_cxx_compiler_flag(-march=native ALHAZEN_TAKES_MARCH_NATIVE)
  check_cxx_compiler_flag(-mcpu=native ALHAZEN_TAKES_MCPU_NATIVE)
  if(ALHAZEN_TAKES_MARCH_NATIVE)
    set(ALHAZEN_INSTRUCTION_SET -march=native)
  elseif(ALHAZEN_TAKES_MCPU_NATIVE)
    set(ALHAZEN_INSTRUCTION_SET -mcpu=native)
  endif()
endif()
