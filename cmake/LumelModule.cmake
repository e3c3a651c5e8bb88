# lumel_module(name [LIBS third-party...]): every .cpp of src/<name> but *_test.cpp becomes the object library
# lumel_<name>; each *_test.cpp joins the test program test_<name>. Who may include whom is in src/LAYERS, checked by
# tests/layers.
function(lumel_module name)
  cmake_parse_arguments(arg "" "" "LIBS;TEST_LIBS" ${ARGN})
  set(dir ${PROJECT_SOURCE_DIR}/src/${name})
  file(GLOB sources CONFIGURE_DEPENDS ${dir}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${dir}/*.h)
  set(tests ${sources})
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  if(sources)
    add_library(lumel_${name} OBJECT ${sources} ${headers})
    target_link_libraries(lumel_${name} PRIVATE lumel_options ${arg_LIBS})
    target_sources(lumel PRIVATE $<TARGET_OBJECTS:lumel_${name}>)
    target_link_libraries(lumel PRIVATE ${arg_LIBS})
  endif()
  if(tests AND LUMEL_TESTS)
    add_executable(test_${name} ${tests})
    target_link_libraries(test_${name} PRIVATE lumel lumel_options lumel_test_support GTest::gtest GTest::gtest_main
      ${arg_LIBS} ${arg_TEST_LIBS})
    gtest_discover_tests(test_${name} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS quick TIMEOUT 300)
  endif()
endfunction()
