# ASPIC_BITS=portable: elementary functions of musl, as in the WebAssembly build, from the sources of emscripten.
set(emscripten /usr/share/emscripten CACHE PATH "Folder of emscripten")
set(musl ${emscripten}/system/lib/libc/musl)
if(NOT EXISTS ${musl}/src/math/sin.c)
  message(FATAL_ERROR "ASPIC_BITS=portable needs emscripten: ${musl} is missing (Debian: apt-get install emscripten)")
endif()
enable_language(C)
set(musl_sources)
foreach(name acos acosh asin asinh atan atan2 atanh cbrt cos cosh exp exp2 exp_data expm1 hypot log log10 log1p log2 log2_data
             log_data pow pow_data scalbn sin sincos sinh tan tanh __cos __expo2 __rem_pio2 __rem_pio2_large __sin __tan
             __math_divzero __math_invalid __math_oflow __math_uflow __math_xflow)
  list(APPEND musl_sources ${musl}/src/math/${name}.c)
endforeach()
add_library(aspic_musl OBJECT ${musl_sources})
set_target_properties(aspic_musl PROPERTIES UNITY_BUILD OFF)
target_include_directories(aspic_musl PRIVATE ${musl}/src/internal ${musl}/src/include ${musl}/arch/emscripten)
target_include_directories(aspic_musl SYSTEM PRIVATE ${emscripten}/cache/sysroot/include)
target_compile_options(aspic_musl PRIVATE -O2 -ffp-contract=off -fno-builtin -nostdinc -w)
