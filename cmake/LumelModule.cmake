# lumel_module(name [SEPARATE] [SEPARATE_TESTS] [LIBS third-party...] [HEADER_LIBS third-party...] [TEST_LIBS ...]): every
# .cpp of src/<name> but *_test.cpp becomes the object library lumel_<name>; each *_test.cpp joins the test program
# test_<name>, and each *_long_test.cpp test_<name>_long, which runs with the label `long`. LIBS are linked by whoever links
# lumel; HEADER_LIBS have nothing to link. Who may include whom is in src/LAYERS, checked by tests/layers. SEPARATE and
# SEPARATE_TESTS: files that use one name for several things in their unnamed namespaces, which LUMEL_UNITY leaves alone.
function(lumel_module name)
  cmake_parse_arguments(arg "SEPARATE;SEPARATE_TESTS" "" "LIBS;HEADER_LIBS;TEST_LIBS" ${ARGN})
  set(dir ${PROJECT_SOURCE_DIR}/src/${name})
  file(GLOB sources CONFIGURE_DEPENDS ${dir}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${dir}/*.h)
  set(tests ${sources})
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  set(long_tests ${tests})
  list(FILTER long_tests INCLUDE REGEX "_long_test\\.cpp$")
  list(FILTER tests EXCLUDE REGEX "_long_test\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  if(sources)
    add_library(lumel_${name} OBJECT ${sources} ${headers})
    target_link_libraries(lumel_${name} PRIVATE lumel_options ${arg_LIBS} ${arg_HEADER_LIBS})
    if(NOT arg_SEPARATE)
      lumel_compile_together(lumel_${name})
    endif()
    if(nlohmann_json::nlohmann_json IN_LIST arg_HEADER_LIBS)
      lumel_use_precompiled(lumel_${name} lumel_json_headers)
    elseif(Eigen3::Eigen IN_LIST arg_HEADER_LIBS)
      lumel_use_precompiled(lumel_${name} lumel_eigen_headers)
    else()
      lumel_use_precompiled(lumel_${name} lumel_headers)
    endif()
    target_sources(lumel PRIVATE $<TARGET_OBJECTS:lumel_${name}>)
    target_link_libraries(lumel PRIVATE ${arg_LIBS})
  endif()
  if(NOT LUMEL_TESTS)
    return()
  endif()
  set(libs ${arg_LIBS} ${arg_HEADER_LIBS} ${arg_TEST_LIBS})
  lumel_test_program(test_${name} quick "${tests}" "${libs}")
  if(NOT arg_SEPARATE_TESTS)
    lumel_compile_together(test_${name})
  endif()
  lumel_test_program(test_${name}_long long "${long_tests}" "${libs}")
endfunction()

# LUMEL_UNITY: sixteen files at a time, which two cores share out evenly. Never in the build that users make, which must
# see every include that a file lacks.
function(lumel_compile_together target)
  if(LUMEL_UNITY AND TARGET ${target})
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  endif()
endfunction()

function(lumel_test_program program label sources libs)
  if(sources)
    add_executable(${program} ${sources})
    target_link_libraries(${program} PRIVATE lumel lumel_options lumel_test_support GTest::gtest GTest::gtest_main
      ${libs})
    lumel_use_precompiled(${program} lumel_test_headers)
    lumel_compile_tests_quickly(${program})
    lumel_discover_tests(${program} ${label})
  endif()
endfunction()

# Tests spend their time in the library; their own code takes twice as long to compile at -O3 and gains nothing by it.
function(lumel_compile_tests_quickly program)
  target_compile_options(${program} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Each TEST of a gtest program becomes a ctest of the given label: `quick` is what scripts/test runs, `long` what
# scripts/test --long adds. A sanitizer makes a program ten times slower, and its time limit longer.
function(lumel_discover_tests program label)
  set(seconds 300)
  if(LUMEL_SANITIZE)
    set(seconds 1500)
  endif()
  gtest_discover_tests(${program} NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60 PROPERTIES LABELS ${label} TIMEOUT ${seconds})
endfunction()
