# alpenglow_find_dependencies, alpenglow_public_headers, alpenglow_install_package: what the libraries need, and what
# projects that use the installed libraries find: CMake packages, files for pkg-config, headers, manuals.

# alpenglow_find_dependencies(<component> ...): finds what the components link to, or stops with a message.
macro(alpenglow_find_dependencies)
  set(CMAKE_FIND_PACKAGE_NAME alpenglow)
  set(alpenglow_FIND_REQUIRED TRUE)
  foreach(component ${ARGN})
    include(${PROJECT_SOURCE_DIR}/.cmake/dependencies/${component}.cmake)
    if(DEFINED alpenglow_FOUND AND NOT alpenglow_FOUND)
      message(FATAL_ERROR "${alpenglow_NOT_FOUND_MESSAGE}")
    endif()
  endforeach()
  unset(alpenglow_FIND_REQUIRED)
  unset(CMAKE_FIND_PACKAGE_NAME)
endmacro()

# alpenglow::alpenglow: the public headers and all libraries. scene.h needs alpenglow::renderer, and the others need
# alpenglow::lut.
function(alpenglow_public_headers)
  list(GET ALPENGLOW_COMPONENTS -1 last)
  set(library alpenglow_${last})
  if(BUILD_SHARED_LIBS)
    set(library ${library}_shared)
  endif()
  add_library(alpenglow_alpenglow INTERFACE)
  add_library(alpenglow::alpenglow ALIAS alpenglow_alpenglow)
  set_target_properties(alpenglow_alpenglow PROPERTIES EXPORT_NAME alpenglow)
  target_include_directories(alpenglow_alpenglow INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(alpenglow_alpenglow INTERFACE ${library})
  install(TARGETS alpenglow_alpenglow EXPORT alpenglow_${last})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/alpenglow DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    COMPONENT headers)
endfunction()

# alpenglow_pkg_config(<name> DESCRIPTION <text> REQUIRES <package> ... LIBS <option> ...)
function(alpenglow_pkg_config name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "DESCRIPTION" "REQUIRES;LIBS")
  list(JOIN arg_REQUIRES " " requires)
  list(JOIN arg_LIBS " " libraries)
  set(file ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc)
  # The folder is relative to that of the file, so that an installation can be moved.
  file(RELATIVE_PATH prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  string(REGEX REPLACE "/$" "" prefix ${prefix})
  file(CONFIGURE OUTPUT ${file} @ONLY CONTENT
"prefix=\${pcfiledir}/@prefix@
includedir=\${prefix}/@CMAKE_INSTALL_INCLUDEDIR@
libdir=\${prefix}/@CMAKE_INSTALL_LIBDIR@

Name: @name@
Description: @arg_DESCRIPTION@
Version: @PROJECT_VERSION@
Requires: @requires@
Libs: @libraries@
Cflags: -I\${includedir}
")
  install(FILES ${file} DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

# The manuals keep their folders, so that their links to each other work.
function(alpenglow_install_documents)
  install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
  foreach(document atmosphere/README.md atmosphere/ATMOSPHERE_FILE.md lut/README.md lut/MANUAL.md lut/ACCURACY.md
      renderer/README.md renderer/MANUAL.md viewer/README.md viewer/MANUAL.md)
    get_filename_component(folder ${document} DIRECTORY)
    install(FILES ${document} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder})
  endforeach()
endfunction()

# The package that find_package(alpenglow COMPONENTS ...) reads, and files for pkg-config.
function(alpenglow_install_package)
  include(CMakePackageConfigHelpers)
  set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/alpenglow)
  set(config ${CMAKE_CURRENT_BINARY_DIR}/alpenglowConfig.cmake)
  # A shared library has found its libraries when it was linked.
  set(with_dependencies TRUE)
  if(BUILD_SHARED_LIBS)
    set(with_dependencies FALSE)
  endif()
  file(CONFIGURE OUTPUT ${config} @ONLY CONTENT
[=[
# find_package(alpenglow [COMPONENTS <component> ...]): all components, or those that are named and the ones below.
set(alpenglow_installed @ALPENGLOW_COMPONENTS@)
set(alpenglow_last -1)
if(NOT alpenglow_FIND_COMPONENTS)
  list(LENGTH alpenglow_installed alpenglow_last)
  math(EXPR alpenglow_last "${alpenglow_last} - 1")
endif()
foreach(alpenglow_component ${alpenglow_FIND_COMPONENTS})
  list(FIND alpenglow_installed "${alpenglow_component}" alpenglow_at)
  if(alpenglow_at GREATER alpenglow_last)
    set(alpenglow_last ${alpenglow_at})
  endif()
  if(alpenglow_at LESS 0 AND alpenglow_FIND_REQUIRED_${alpenglow_component})
    set(alpenglow_FOUND FALSE)
    list(JOIN alpenglow_installed ", " alpenglow_names)
    set(alpenglow_NOT_FOUND_MESSAGE
      "alpenglow has no component ${alpenglow_component} (components: ${alpenglow_names})")
    return()
  endif()
endforeach()

set(alpenglow_at 0)
foreach(alpenglow_component ${alpenglow_installed})
  if(alpenglow_at GREATER alpenglow_last)
    break()
  endif()
  math(EXPR alpenglow_at "${alpenglow_at} + 1")
  if(@with_dependencies@)
    include("${CMAKE_CURRENT_LIST_DIR}/dependencies/${alpenglow_component}.cmake")
    if(DEFINED alpenglow_FOUND AND NOT alpenglow_FOUND)
      return()
    endif()
  endif()
  include("${CMAKE_CURRENT_LIST_DIR}/alpenglow_${alpenglow_component}.cmake")
  set(alpenglow_${alpenglow_component}_FOUND TRUE)
endforeach()
]=])
  write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/alpenglowConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES ${config} ${CMAKE_CURRENT_BINARY_DIR}/alpenglowConfigVersion.cmake DESTINATION ${destination})
  # Packages of pkg-config that a static library links to, and libraries without such a package.
  set(requires_atmosphere fmt tbb geographiclib erfa tomlplusplus)
  set(libraries_atmosphere -ldate-tz)
  set(requires_lut OpenEXR libpng)
  set(requires_renderer gdal tinyxml2 zlib)
  set(libraries_renderer -lembree${embree_VERSION_MAJOR})
  set(below)
  foreach(component ${ALPENGLOW_COMPONENTS})
    install(EXPORT alpenglow_${component} NAMESPACE alpenglow:: FILE alpenglow_${component}.cmake
      DESTINATION ${destination})
    set(requires ${below})
    set(libraries -L\${libdir} -lalpenglow_${component})
    if(with_dependencies)
      install(FILES .cmake/dependencies/${component}.cmake DESTINATION ${destination}/dependencies)
      list(APPEND requires ${requires_${component}})
      list(APPEND libraries ${libraries_${component}})
    endif()
    alpenglow_pkg_config(alpenglow-${component} REQUIRES ${requires} LIBS ${libraries}
      DESCRIPTION "${PROJECT_DESCRIPTION} (${component})")
    set(below alpenglow-${component})
  endforeach()
  alpenglow_pkg_config(alpenglow REQUIRES ${below} DESCRIPTION "${PROJECT_DESCRIPTION}")
  alpenglow_install_documents()
endfunction()
