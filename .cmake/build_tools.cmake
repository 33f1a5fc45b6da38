# Compiles through ccache where it is installed: a second folder, or a second preset's first build after a
# change, takes what has been compiled before. -DCMAKE_CXX_COMPILER_LAUNCHER= of one's own wins.
option(ALPENGLOW_CCACHE "Compile through ccache where it is installed" ON)
find_program(ALPENGLOW_CCACHE_PROGRAM ccache)
mark_as_advanced(ALPENGLOW_CCACHE_PROGRAM)
if(ALPENGLOW_CCACHE AND ALPENGLOW_CCACHE_PROGRAM AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  # Paths of the tree count from its top, so that its place does not matter; precompiled headers need the
  # sloppiness that ccache's manual names for them ("Precompiled headers").
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
    ${ALPENGLOW_CCACHE_PROGRAM})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    string(PREPEND CMAKE_CXX_FLAGS "-fpch-preprocess ")
  endif()
endif()

# Links with mold where it is installed: GNU ld takes seconds for each of the test programs.
option(ALPENGLOW_MOLD "Link with mold where it is installed" ON)
find_program(ALPENGLOW_MOLD_PROGRAM mold)
mark_as_advanced(ALPENGLOW_MOLD_PROGRAM)
if(ALPENGLOW_MOLD AND ALPENGLOW_MOLD_PROGRAM AND
   (NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU" OR CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12.1))
  add_link_options(-fuse-ld=mold)
endif()

# gcc collects its garbage only beyond 2 GB: sources that are compiled as one need less (at most 1 GB), and
# collecting takes a tenth of the time.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(--param=ggc-min-heapsize=2000000)
endif()

# tinyxml2 of Debian 13 defines this for what links to it. Precompiled headers are read only where the same is defined.
add_compile_definitions(_FILE_OFFSET_BITS=64)
