# Installs the tool, the library, its public headers and the CMake package `lumel` (tests/consumer builds against it).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lumel)

install(TARGETS lumel EXPORT lumelTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT lumelTargets NAMESPACE lumel:: DESTINATION ${package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lumel DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.h)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/shaders DESTINATION ${CMAKE_INSTALL_DATADIR}/lumel)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/lumelConfig.cmake.in
  ${PROJECT_BINARY_DIR}/lumelConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lumelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/lumelConfig.cmake ${PROJECT_BINARY_DIR}/lumelConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindEmbree.cmake ${PROJECT_SOURCE_DIR}/cmake/FindTurboJpeg.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindZstd.cmake
  DESTINATION ${package_dir})
