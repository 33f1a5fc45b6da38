# alpenglow_library, alpenglow_study, alpenglow_kernels, alpenglow_program, alpenglow_tests, alpenglow_embed: a target
# is a few lines.

add_library(alpenglow_warnings INTERFACE)
target_compile_options(alpenglow_warnings INTERFACE
  # clang's -Wdouble-promotion rejects long double, too.
  -Wall -Wextra -Wpedantic -Wconversion $<$<CXX_COMPILER_ID:GNU>:-Wdouble-promotion> -Wshadow
  $<$<CXX_COMPILER_ID:GNU>:-Wcast-align=strict>
  $<$<BOOL:${ALPENGLOW_WARNINGS_AS_ERRORS}>:-Werror>
  # Not -ffast-math: infinities and NaN mean what they mean. Contraction is off so that one source
  # gives one result on every machine.
  -fno-math-errno -fno-trapping-math -ffp-contract=off
  # Messages and debug information name files from the top of the tree.
  -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=
  # Of a type in an anonymous namespace it warns where that stands in an included file. All sources are
  # included where several are compiled as one (CMAKE_UNITY_BUILD).
  $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>)

# Not cache variables: project() has put empty ones of these names into the cache, which would win. -O2
# takes up to twice as long to compile. Four checks are off, because they are made at every access to a member
# and add a half to the time to compile (a source of eight: 9.1 s instead of 6.2 s). Other means find the same
# faults: the processor finds null pointers, the address sanitizer finds accesses beyond an object, and
# -Wcast-align=strict finds wrong alignment. No code casts a pointer down to a class with virtual functions.
set(CMAKE_CXX_FLAGS_SANITIZE "-O1 -g1 -fsanitize=address,undefined \
-fno-sanitize=null,alignment,object-size,vptr -fno-sanitize-recover=all -fno-omit-frame-pointer")
# Checks for use after scope take a quarter of the time to compile libraries and of the time of the tests. Checks
# for overflow of pointers take 3 to 18 % of the time to compile a source; where such a pointer is used, the
# address sanitizer finds the access.
option(ALPENGLOW_SLOW_CHECKS
  "The sanitizers also find the use of local variables after their scope, and pointers that overflow" ON)
if(NOT ALPENGLOW_SLOW_CHECKS)
  string(APPEND CMAKE_CXX_FLAGS_SANITIZE " -fno-sanitize=pointer-overflow")
  string(APPEND CMAKE_CXX_FLAGS_SANITIZE " -fno-sanitize-address-use-after-scope")
endif()
set(CMAKE_C_FLAGS_SANITIZE "${CMAKE_CXX_FLAGS_SANITIZE}")
set(CMAKE_EXE_LINKER_FLAGS_SANITIZE "-fsanitize=address,undefined")

# Programs and tests spend their time in the libraries and are optimised little: the templates of CLI11 and
# GoogleTest take long to optimise, with sanitizers three times as long as all other code. Tests are not
# optimised at all: they take a third less to compile than at -O1, and a twentieth more to run.
set(ALPENGLOW_LITTLE_OPTIMISATION $<$<CONFIG:Release>:-O1> $<$<CONFIG:Sanitize>:-O0>)
set(ALPENGLOW_NO_OPTIMISATION $<$<CONFIG:Release,Sanitize>:-O0>)

# alpenglow_precompiled: all libraries share its precompiled headers. It has no macros of one library, because
# gcc rejects precompiled headers with other macros.
function(alpenglow_precompiled_headers)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled.cpp CONTENT "")
  add_library(alpenglow_precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
  target_compile_features(alpenglow_precompiled PRIVATE cxx_std_20)
  target_include_directories(alpenglow_precompiled PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(alpenglow_precompiled PRIVATE alpenglow_warnings glm::glm fmt::fmt TBB::tbb)
  target_precompile_headers(alpenglow_precompiled PRIVATE <.cmake/precompiled.h>)
endfunction()

# alpenglow_many_as_one(<target> <owner of precompiled headers>): twenty sources are compiled as one where the
# default is eight, because the code of templates that sources share is generated once. They take at most 1 GB.
function(alpenglow_many_as_one target headers)
  target_precompile_headers(${target} REUSE_FROM ${headers})
  set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 20)
endfunction()

# alpenglow_library(<folder> [ABOVE <folder below>] SOURCES a.cpp ... API b.cpp ...): links to the library below it.
# The sources in API implement the public headers. They are compiled one by one, because some public types have names
# of a layer's types.
#
# The library is static: programs and tests need what the public headers do not have. With BUILD_SHARED_LIBS, a
# shared library of the same name is built for others: it exports what the public headers declare
# (include/alpenglow/export.h), and contains what it needs of the static libraries.
function(alpenglow_library folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "ABOVE" "SOURCES;API")
  set(target alpenglow_${folder})
  add_library(${target} STATIC ${arg_SOURCES} ${arg_API})
  set_source_files_properties(${arg_API} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  add_library(alpenglow::${folder} ALIAS ${target})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:alpenglow_warnings>)
  if(arg_ABOVE)
    target_link_libraries(${target} PUBLIC alpenglow_${arg_ABOVE})
  endif()
  alpenglow_many_as_one(${target} alpenglow_precompiled)
  set(installed ${target})
  if(BUILD_SHARED_LIBS)
    set(installed ${target}_shared)
    add_library(${installed} SHARED ${arg_API})
    target_compile_features(${installed} PUBLIC cxx_std_20)
    if(arg_ABOVE)
      # First, so that public functions of the layer below come from its shared library.
      target_link_libraries(${installed} PUBLIC alpenglow_${arg_ABOVE}_shared)
    endif()
    target_link_libraries(${installed} PRIVATE ${target} alpenglow_warnings)
    set_target_properties(${installed} PROPERTIES OUTPUT_NAME ${target} VERSION ${PROJECT_VERSION}
      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} INSTALL_RPATH "$ORIGIN")
  else()
    # A plug-in that links the library does not export its symbols.
    target_compile_definitions(${target} PRIVATE ALPENGLOW_EXPORT=)
  endif()
  set_target_properties(${installed} PROPERTIES EXPORT_NAME ${folder})
  target_include_directories(${installed} PUBLIC $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  install(TARGETS ${installed} EXPORT alpenglow_${folder} COMPONENT ${folder}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} NAMELINK_COMPONENT ${folder})
endfunction()

# alpenglow_study(<name> SOURCES a.cpp ... LIBRARIES ...): a static library that measures the others and is not
# installed. Only programs and tests link to it.
function(alpenglow_study name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LIBRARIES")
  set(target alpenglow_${name})
  add_library(${target} STATIC ${arg_SOURCES})
  target_link_libraries(${target} PUBLIC ${arg_LIBRARIES} PRIVATE alpenglow_warnings TBB::tbb)
  alpenglow_many_as_one(${target} alpenglow_precompiled)
endfunction()

# The instruction sets that kernels are compiled for (atmosphere/shared_glsl/instruction_set.h), and their options.
# Multiplication and addition may fuse where the processor has one instruction for both.
set(ALPENGLOW_INSTRUCTION_SETS Scalar Baseline)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  list(APPEND ALPENGLOW_INSTRUCTION_SETS Avx2 Avx512)
endif()
set(ALPENGLOW_OPTIONS_Scalar)
set(ALPENGLOW_OPTIONS_Baseline)
set(ALPENGLOW_OPTIONS_Avx2 -mavx2 -mfma -ffp-contract=fast)
set(ALPENGLOW_OPTIONS_Avx512 ${ALPENGLOW_OPTIONS_Avx2}
  -mavx512f -mavx512cd -mavx512dq -mavx512bw -mavx512vl
  # gcc 12 takes its own _mm512_undefined_ps for a mistake.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized> $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized>)

# alpenglow_kernels(<library target> a_kernel.cpp ...): compiles the files once per instruction set and
# puts the objects into the library. Optimised in every configuration: without inlining their symbols
# would leak. Under sanitizers, batches at -O1 are half as fast, and scalar kernels at -O2 take three
# times as long to compile.
function(alpenglow_kernels target)
  set(sets)
  if("Avx2" IN_LIST ALPENGLOW_INSTRUCTION_SETS)
    set(sets ALPENGLOW_X86_KERNELS)
  endif()
  # The choice is made in a header, so all who include it must see the same sets. That header is not installed.
  target_compile_definitions(${target} PUBLIC $<BUILD_INTERFACE:${sets}>)
  foreach(set ${ALPENGLOW_INSTRUCTION_SETS})
    set(objects ${target}_kernels_${set})
    add_library(${objects} OBJECT ${ARGN})
    target_compile_features(${objects} PRIVATE cxx_std_20)
    target_include_directories(${objects} PRIVATE
      $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
    target_compile_definitions(${objects} PRIVATE ${sets} ALPENGLOW_KERNEL_SET=k${set}
      $<$<NOT:$<STREQUAL:${set},Scalar>>:ALPENGLOW_BATCHES>)
    target_compile_options(${objects} PRIVATE
      $<TARGET_PROPERTY:alpenglow_warnings,INTERFACE_COMPILE_OPTIONS>
      $<$<CONFIG:Debug>:-O2> $<$<CONFIG:Check>:-O1>
      $<$<AND:$<CONFIG:Sanitize>,$<NOT:$<STREQUAL:${set},Scalar>>>:-O2> ${ALPENGLOW_OPTIONS_${set}}
      # Batches are passed by reference. Checks of their scope, on top of the four that are off, make
      # kernels 14 times slower, and they take 5 times as long to compile.
      $<$<CONFIG:Sanitize>:-fno-sanitize-address-use-after-scope>)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
    set_property(GLOBAL APPEND PROPERTY ALPENGLOW_KERNEL_OBJECTS ${objects})
  endforeach()
endfunction()

# alpenglow_program(<name> <source> [SOURCES ...] LIBRARIES ...)
function(alpenglow_program name source)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "SOURCES;LIBRARIES")
  add_executable(${name} ${source} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} alpenglow_warnings)
  target_compile_options(${name} PRIVATE ${ALPENGLOW_LITTLE_OPTIMISATION})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
endfunction()

# alpenglow_embed(<target> <files>...): the text of each file becomes a string in the library, all in one
# generated source. "data/cie.csv" of folder atmosphere is EmbeddedText("atmosphere/data/cie.csv") of
# "atmosphere/embedded_text.h", which the build writes.
function(alpenglow_embed target)
  set(names)
  foreach(file ${ARGN})
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    list(APPEND names ${name})
  endforeach()
  string(REPLACE alpenglow_ "" folder ${target})
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_text.cpp)
  # In an object of its own, which links to nothing. In the library itself, no source would be compiled before
  # all libraries that it links to are complete.
  add_library(${target}_text OBJECT ${output})
  target_compile_features(${target}_text PRIVATE cxx_std_20)
  # Without alpenglow_warnings: clang warns of literals beyond the 65,536 characters that C++ promises.
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} "-DFILES=${names}" -DSOURCE=${PROJECT_SOURCE_DIR} -DOUTPUT=${output}
            -DFOLDER=${folder} -P ${PROJECT_SOURCE_DIR}/.cmake/embed.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/.cmake/embed.cmake
    VERBATIM)
  file(CONFIGURE OUTPUT ${generated}/${folder}/embedded_text.h @ONLY CONTENT
"// Written by alpenglow_embed: files of folder @folder@ that travel inside its library.
#pragma once
#include <string>
#include <string_view>

#include \"atmosphere/base/error.h\"

namespace alpenglow::@folder@ {
/// The text of a file, or a view without data for a name that was not embedded.
std::string_view FindEmbeddedText(std::string_view name);

/// The text of a file, named from the top of the tree. Throws InternalError for a name that was not
/// embedded (CMakeLists.txt of the folder).
inline std::string_view EmbeddedText(std::string_view name) {
  const std::string_view text = FindEmbeddedText(name);
  if (text.data() == nullptr) throw atmosphere::InternalError(\"no embedded text \" + std::string(name));
  return text;
}
}  // namespace alpenglow::@folder@
")
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_text>)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${generated}>)
endfunction()

# alpenglow_test_headers: all tests share its precompiled headers and are not optimised.
function(alpenglow_test_headers)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp CONTENT "")
  add_library(alpenglow_test_headers OBJECT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
  target_link_libraries(alpenglow_test_headers PUBLIC
    alpenglow::renderer alpenglow_warnings TBB::tbb GTest::gmock GTest::gtest)
  target_compile_options(alpenglow_test_headers PUBLIC ${ALPENGLOW_NO_OPTIMISATION})
  target_precompile_headers(alpenglow_test_headers PRIVATE
    <.cmake/precompiled.h> <gmock/gmock.h> <gtest/gtest.h>)
endfunction()

# alpenglow_places(<program> [skylut ...]): what tests/fixtures/places.h declares, and that the programs are
# built before.
function(alpenglow_places program)
  set(text "namespace alpenglow::tests {
extern const char* const kSourceFolder = \"${PROJECT_SOURCE_DIR}\";
extern const char* const kSharedFolder = \"${PROJECT_SOURCE_DIR}/../shared\";
")
  foreach(other ${ARGN})
    string(REGEX REPLACE "_([a-z])" ";\\1" parts "_${other}")
    set(name k)
    foreach(part ${parts})
      string(SUBSTRING "${part}" 0 1 first)
      string(SUBSTRING "${part}" 1 -1 rest)
      string(TOUPPER "${first}" first)
      string(APPEND name "${first}${rest}")
    endforeach()
    string(APPEND text "extern const char* const ${name} = \"$<TARGET_FILE:${other}>\";\n")
    # Only the link waits for the other program, not every source.
    if(CMAKE_GENERATOR MATCHES "Ninja")
      set_property(TARGET ${program} APPEND PROPERTY LINK_DEPENDS $<TARGET_FILE:${other}>)
    else()
      add_dependencies(${program} ${other})
    endif()
  endforeach()
  set(places ${CMAKE_CURRENT_BINARY_DIR}/${program}_places.cpp)
  file(GENERATE OUTPUT ${places} CONTENT "${text}}  // namespace alpenglow::tests\n")
  set_source_files_properties(${places} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  target_sources(${program} PRIVATE ${places})
endfunction()

# Sets the variable `out` to the filter of GoogleTest that takes all suites of the sources.
function(alpenglow_suites out)
  set(filter)
  foreach(source ${ARGN})
    file(STRINGS ${source} suites REGEX "^(TEST|TEST_F|TEST_P|RC_GTEST_PROP)\\(")
    list(TRANSFORM suites REPLACE "^[A-Z_]+\\(([A-Za-z0-9]+),.*" "\\1.*:*/\\1.*")
    list(APPEND filter ${suites})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
  endforeach()
  list(REMOVE_DUPLICATES filter)
  list(JOIN filter ":" filter)
  set(${out} "${filter}" PARENT_SCOPE)
endfunction()

# alpenglow_tests(<program> FOLDER f [LONG a_test.cpp ...] SOURCES b_test.cpp ... LIBRARIES ...
# [PROGRAMS skylut ...] [SMOKE b_test.cpp ...] [SCALAR b_test.cpp ... [BUT Suite.Test ...]]): one program of
# tests, one CTest line a source, "f.<name of the source>": its tests share what is costly, and a process
# takes longer to start than most tests (0.2 s, under the sanitizers 0.5 s). Each line writes its results to
# tests/results/<line>.xml. The sources in LONG start first. Those in SMOKE, which are any of both, have the
# label smoke. PROGRAMS are built before; tests/fixtures/places.h names their paths. The sources in SCALAR run
# a second time with scalar kernels, in one line "scalar.<program>", without the tests that BUT names.
function(alpenglow_tests program)
  if(NOT TARGET alpenglow_test_headers)
    alpenglow_test_headers()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "FOLDER"
    "LONG;SOURCES;LIBRARIES;PROGRAMS;SMOKE;SCALAR;BUT")
  add_executable(${program} ${arg_LONG} ${arg_SOURCES})
  target_link_libraries(${program} PRIVATE
    alpenglow_test_headers ${arg_LIBRARIES} GTest::gtest_main)
  alpenglow_places(${program} ${arg_PROGRAMS})
  alpenglow_many_as_one(${program} alpenglow_test_headers)
  set(all "")
  foreach(source ${arg_LONG} ${arg_SOURCES})
    get_filename_component(name ${source} NAME_WE)
    alpenglow_suites(filter ${source})
    if(filter)
      string(APPEND all ":${filter}")
      alpenglow_test_line(${arg_FOLDER}.${name} ${program} "${filter}")
    endif()
    if(source IN_LIST arg_LONG)
      # So that no processor waits for it in the end.
      set_tests_properties(${arg_FOLDER}.${name} PROPERTIES COST 100)
    endif()
    if(source IN_LIST arg_SMOKE)
      set_tests_properties(${arg_FOLDER}.${name} PROPERTIES LABELS smoke)
    endif()
  endforeach()
  # A test whose suite no line has found would never run.
  add_test(NAME ${arg_FOLDER}.EveryTestOf_${program}_HasALine
    COMMAND ${program} --gtest_list_tests "--gtest_filter=-${all}")
  set_tests_properties(${arg_FOLDER}.EveryTestOf_${program}_HasALine PROPERTIES
    FAIL_REGULAR_EXPRESSION "\\.\n")
  if(arg_SCALAR)
    alpenglow_suites(filter ${arg_SCALAR})
    list(JOIN arg_BUT ":" but)
    alpenglow_test_line(scalar.${program} ${program} "${filter}:-${but}")
    set_tests_properties(scalar.${program} PROPERTIES LABELS scalar COST 100)
    set_property(TEST scalar.${program} APPEND PROPERTY
      ENVIRONMENT ALPENGLOW_INSTRUCTION_SET=scalar)
  endif()
endfunction()

# Tests do not use the user's caches. The presets name one folder, so that the heights of the built-in range are
# made once for the tests of all presets, and so are the shaders of software OpenGL (Mesa). Those are not
# optimised: for the small pictures of tests they run as fast, and they take a third less to compile.
set(ALPENGLOW_TEST_CACHE ${PROJECT_BINARY_DIR}/cache CACHE PATH "Where tests keep the built-in range and shaders")
set(ALPENGLOW_TEST_ENVIRONMENT
  ALPENGLOW_CACHE=${ALPENGLOW_TEST_CACHE} MESA_SHADER_CACHE_DIR=${ALPENGLOW_TEST_CACHE} GALLIVM_PERF=nopt)
# Memory comes in pages of 2 MB where the kernel has them, and freed memory stays in the process: glibc returns
# each large block to the kernel, and the next one costs a page fault every 4 kB. viewer_tests
# --gtest_filter='LandPictures.Keep*:DisplayPass*' takes 10.6 s of processor time instead of 12.5 s. The sanitizers
# have an allocator of their own.
if(NOT CMAKE_BUILD_TYPE STREQUAL "Sanitize")
  string(JOIN ":" kept_memory glibc.malloc.hugetlb=1 glibc.malloc.mmap_max=0
    glibc.malloc.trim_threshold=4000000000 glibc.malloc.top_pad=67108864)
  list(APPEND ALPENGLOW_TEST_ENVIRONMENT GLIBC_TUNABLES=${kept_memory})
endif()

# One CTest line: the tests of a program that a filter takes.
function(alpenglow_test_line line program filter)
  add_test(NAME ${line} COMMAND ${program} "--gtest_filter=${filter}"
    --gtest_output=xml:${CMAKE_CURRENT_BINARY_DIR}/results/${line}.xml)
  set_tests_properties(${line} PROPERTIES TIMEOUT 1800
    ENVIRONMENT "${ALPENGLOW_TEST_ENVIRONMENT}")
endfunction()
