# What alpenglow::atmosphere links to. Read by the build and, installed, by find_package(alpenglow).
include(CMakeFindDependencyMacro)

find_dependency(Threads)
find_dependency(fmt)
find_dependency(tomlplusplus)
find_dependency(date)
find_dependency(TBB)

# alpenglow_find_library(<name> HEADER <header> NAMES <library> ...): target alpenglow_<name> for a library without a
# CMake package, or with one that defines no target.
macro(alpenglow_find_library name)
  if(NOT TARGET alpenglow_${name})
    cmake_parse_arguments(alpenglow_find "" "HEADER" "NAMES" ${ARGN})
    find_library(ALPENGLOW_${name}_LIBRARY NAMES ${alpenglow_find_NAMES})
    find_path(ALPENGLOW_${name}_INCLUDE_DIR ${alpenglow_find_HEADER})
    mark_as_advanced(ALPENGLOW_${name}_LIBRARY ALPENGLOW_${name}_INCLUDE_DIR)
    if(NOT ALPENGLOW_${name}_LIBRARY OR NOT ALPENGLOW_${name}_INCLUDE_DIR)
      set(${CMAKE_FIND_PACKAGE_NAME}_FOUND FALSE)
      set(${CMAKE_FIND_PACKAGE_NAME}_NOT_FOUND_MESSAGE "${name} was not found (${alpenglow_find_HEADER})")
      if(NOT CMAKE_FIND_PACKAGE_NAME)
        message(FATAL_ERROR "${name} was not found (${alpenglow_find_HEADER})")
      endif()
      return()
    endif()
    add_library(alpenglow_${name} INTERFACE IMPORTED)
    target_link_libraries(alpenglow_${name} INTERFACE ${ALPENGLOW_${name}_LIBRARY})
    target_include_directories(alpenglow_${name} INTERFACE ${ALPENGLOW_${name}_INCLUDE_DIR})
  endif()
endmacro()
# GeographicLib 2.1 is named GeographicLib, older ones are named Geographic.
alpenglow_find_library(GeographicLib HEADER GeographicLib/Geocentric.hpp NAMES GeographicLib Geographic)
alpenglow_find_library(erfa HEADER erfa.h NAMES erfa)
