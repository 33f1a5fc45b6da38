# alpenglow_version_header(<file>): release, git describe and compiler as C++ constants. The file
# changes only when they do; every commit configures again.
function(alpenglow_version_header file)
  set(describe "no git")
  find_package(Git QUIET)
  if(GIT_FOUND)
    execute_process(
      COMMAND ${GIT_EXECUTABLE} describe --always --dirty --tags
      WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
      OUTPUT_VARIABLE answer RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(NOT failed)
      set(describe "${answer}")
      execute_process(
        COMMAND ${GIT_EXECUTABLE} rev-parse --git-path logs/HEAD
        WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
        OUTPUT_VARIABLE log OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
      get_filename_component(log "${log}" ABSOLUTE BASE_DIR ${PROJECT_SOURCE_DIR})
      if(EXISTS ${log})
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${log})
      endif()
    endif()
  endif()
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}" flags)
  string(REPLACE "\"" "'" flags "${flags}")
  file(CONFIGURE OUTPUT ${file} @ONLY CONTENT
"// Written by alpenglow_version_header.
#pragma once
namespace alpenglow::version {
inline constexpr char kRelease[] = \"@PROJECT_VERSION@\";
inline constexpr char kGitDescribe[] = \"@describe@\";
inline constexpr char kCompiler[] = \"@CMAKE_CXX_COMPILER_ID@\";
inline constexpr char kBuildType[] = \"@CMAKE_BUILD_TYPE@\";
inline constexpr char kFlags[] = \"@flags@\";
inline constexpr char kCompilerVersion[] = \"@CMAKE_CXX_COMPILER_VERSION@\";
}  // namespace alpenglow::version
")
endfunction()
