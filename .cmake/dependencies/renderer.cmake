# What alpenglow::renderer links to beside alpenglow::lut.
include(CMakeFindDependencyMacro)

# Embree 4, or Embree 3.13 where it is missing (renderer/terrain/terrain.cpp uses both).
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_dependency(embree 3.13)
endif()
find_dependency(GDAL)
find_dependency(tinyxml2)
find_dependency(ZLIB)
