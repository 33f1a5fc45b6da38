# What alpenglow::renderer links to beside alpenglow::lut.
include(CMakeFindDependencyMacro)

# Embree 4, or Embree 3.13 where it is missing (renderer/terrain/terrain.cpp uses both).
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_dependency(embree 3.13)
endif()
find_dependency(GDAL)
# OpenVDB has no configuration of its own for CMake.
find_path(OPENVDB_HEADERS openvdb.h PATH_SUFFIXES openvdb)
find_library(OPENVDB_LIBRARY openvdb)
if(NOT OPENVDB_HEADERS OR NOT OPENVDB_LIBRARY)
  message(FATAL_ERROR "OpenVDB was not found (libopenvdb-dev)")
endif()
if(NOT TARGET OpenVDB::openvdb)
  add_library(OpenVDB::openvdb UNKNOWN IMPORTED)
  cmake_path(GET OPENVDB_HEADERS PARENT_PATH OPENVDB_INCLUDES)
  set_target_properties(OpenVDB::openvdb PROPERTIES
    IMPORTED_LOCATION "${OPENVDB_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${OPENVDB_INCLUDES}"
    INTERFACE_LINK_LIBRARIES "TBB::tbb;Imath::Imath")
endif()
find_dependency(tinyxml2)
find_dependency(ZLIB)
