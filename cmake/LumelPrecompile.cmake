# Precompiled headers of libraries that are not ours: LUMEL_PRECOMPILE=ON, else these do nothing. Never our own headers,
# and never in the build that users make, which must see every include that a file lacks (and g++ 14 at -O3 warns of what
# it inlines from them). For the sanitizers' builds.
#   lumel_precompiled(name [LIBS ...] [HEADERS ...])   a set of headers, the standard library's always among them
#   lumel_use_precompiled(target name)                 the target is compiled with that set
function(lumel_precompiled name)
  if(NOT LUMEL_PRECOMPILE)
    return()
  endif()
  cmake_parse_arguments(arg "" "" "LIBS;HEADERS" ${ARGN})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE lumel_options ${arg_LIBS})
  target_precompile_headers(${name} PRIVATE <algorithm> <array> <cmath> <cstdint> <cstdio> <functional> <limits> <map>
    <memory> <numeric> <optional> <random> <span> <string> <string_view> <tuple> <utility> <vector> ${arg_HEADERS})
endfunction()

function(lumel_use_precompiled target name)
  if(LUMEL_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()
