# Finds Embree 4 or 3, whichever the system has, as the target Embree::Embree. Embree's own config files carry absolute
# paths that some distributions break, so the library and header are looked for directly.
find_path(Embree_INCLUDE_DIR NAMES embree4/rtcore.h embree3/rtcore.h)
if(Embree_INCLUDE_DIR AND EXISTS "${Embree_INCLUDE_DIR}/embree4/rtcore.h")
  set(Embree_VERSION_MAJOR 4)
else()
  set(Embree_VERSION_MAJOR 3)
endif()
find_library(Embree_LIBRARY NAMES embree${Embree_VERSION_MAJOR})
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Embree REQUIRED_VARS Embree_LIBRARY Embree_INCLUDE_DIR)
if(Embree_FOUND AND NOT TARGET Embree::Embree)
  add_library(Embree::Embree UNKNOWN IMPORTED)
  set_target_properties(Embree::Embree PROPERTIES
    IMPORTED_LOCATION "${Embree_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${Embree_INCLUDE_DIR}"
    INTERFACE_COMPILE_DEFINITIONS "LUMEL_EMBREE_MAJOR=${Embree_VERSION_MAJOR}")
endif()
