# Toolchain of the sanitizer presets: clang where there is one, so that both compilers see the code; else the default.
find_program(LUMEL_CLANG NAMES clang++-14 clang++-19 clang++)
if(LUMEL_CLANG)
  set(CMAKE_CXX_COMPILER ${LUMEL_CLANG})
endif()
