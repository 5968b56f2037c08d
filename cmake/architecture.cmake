# keyhole_detect_arch(<variable>): x86-64-v3 where the compiler knows it and this machine's processor runs it (AVX2, FMA
# and BMI2 mark it out), otherwise empty. The answer is cached: give KEYHOLE_ARCH when building for another machine.
include(CheckCXXCompilerFlag)
include(CheckCXXSourceRuns)

function(keyhole_detect_arch result)
  check_cxx_compiler_flag(-march=x86-64-v3 KEYHOLE_COMPILER_KNOWS_X86_64_V3)
  check_cxx_source_runs("
    int main() {
        const bool v3 = __builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") && __builtin_cpu_supports(\"bmi2\");
        return v3 ? 0 : 1;
    }" KEYHOLE_MACHINE_RUNS_X86_64_V3)
  if(KEYHOLE_COMPILER_KNOWS_X86_64_V3 AND KEYHOLE_MACHINE_RUNS_X86_64_V3)
    set(${result} x86-64-v3 PARENT_SCOPE)
  else()
    set(${result} "" PARENT_SCOPE)
  endif()
endfunction()
