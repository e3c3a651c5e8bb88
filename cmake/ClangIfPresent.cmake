# Toolchain of the sanitizer presets: clang where there is one, so that both compilers see the code; else the default.
# In CI there must be one: its lanes would pass without clang having seen anything.
find_program(LUMEL_CLANG NAMES clang++-14 clang++-19 clang++)
if(LUMEL_CLANG)
  set(CMAKE_CXX_COMPILER ${LUMEL_CLANG})
elseif(DEFINED ENV{CI})
  message(FATAL_ERROR "CI is set and there is no clang++: this lane is the one in which clang sees the code "
    "(scripts/bootstrap --ci installs it; unset CI to build with the default compiler)")
endif()
