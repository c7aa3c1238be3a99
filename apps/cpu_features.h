// Instruction sets that the compiler may have been told to use: X(its macro, its name to __builtin_cpu_supports).
#pragma once

#define ALHAZEN_FOR_EACH_CPU_FEATURE(X) \
  X(__SSE3__, "sse3")                   \
  X(__SSSE3__, "ssse3")                 \
  X(__SSE4_1__, "sse4.1")               \
  X(__SSE4_2__, "sse4.2")               \
  X(__POPCNT__, "popcnt")               \
  X(__AVX__, "avx")                     \
  X(__AVX2__, "avx2")                   \
  X(__FMA__, "fma")                     \
  X(__BMI__, "bmi")                     \
  X(__BMI2__, "bmi2")                   \
  X(__AVX512F__, "avx512f")             \
  X(__AVX512CD__, "avx512cd")           \
  X(__AVX512BW__, "avx512bw")           \
  X(__AVX512DQ__, "avx512dq")           \
  X(__AVX512VL__, "avx512vl")           \
  X(__AVX512IFMA__, "avx512ifma")       \
  X(__AVX512VBMI__, "avx512vbmi")       \
  X(__AVX512VBMI2__, "avx512vbmi2")     \
  X(__AVX512VNNI__, "avx512vnni")       \
  X(__AVX512BITALG__, "avx512bitalg")   \
  X(__AVX512VPOPCNTDQ__, "avx512vpopcntdq")

/// Whether this program's code may use each of them, in their order. Data alone: defined in a file that is compiled
/// like the rest of the program.
extern "C" const bool alhazen_built_for[];
