# Installs BUILD into PREFIX, configures and builds the consumer against it, runs its programs. The elevation model
# that PYTHON writes is an SRTM tile of hills.
function(attempt status output)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  set(${status} "${result}" PARENT_SCOPE)
  set(${output} "${text}" PARENT_SCOPE)
endfunction()
function(run)
  attempt(status output ${ARGN})
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nexit status ${status}\n${output}")
  endif()
endfunction()
set(configure ${CMAKE_COMMAND} -G Ninja -DCMAKE_PREFIX_PATH=${PREFIX} -DCMAKE_BUILD_TYPE=${TYPE}
  -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_CXX_COMPILER=${COMPILER})

file(REMOVE_RECURSE ${PREFIX} ${BINARY})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX})
run(${configure} -S ${SOURCE} -B ${BINARY})
run(${CMAKE_COMMAND} --build ${BINARY})
run(${configure} -S ${SOURCE}/readme -B ${BINARY}/readme)
run(${CMAKE_COMMAND} --build ${BINARY}/readme)
run(${BINARY}/readme/sky_radiance)
run(${BINARY}/tables ${BINARY}/baked)
run(${BINARY}/clouds)
run(${PYTHON} -c "import math, struct
heights = (int(900 + 600 * math.sin(x / 40) * math.cos(y / 55)) for y in range(1201) for x in range(1201))
open('${BINARY}/N46E008.hgt', 'wb').write(struct.pack('>1442401h', *heights))")
run(${BINARY}/still ${BINARY} ${BINARY}/N46E008.hgt 46.5 8.5)
foreach(picture still.exr still.png)
  file(SIZE ${BINARY}/${picture} size)
  if(size LESS 5000)
    message(FATAL_ERROR "${picture} has ${size} bytes")
  endif()
endforeach()

# A plug-in exports its own function only.
run(${PYTHON} -c "import ctypes
plugin = ctypes.CDLL('${BINARY}/libplugin.so') if '${FLAGS}' == '' else None
if plugin:
    plugin.ZenithLuminance.restype = ctypes.c_double
    assert 100.0 < plugin.ZenithLuminance() < 20000.0")
attempt(status symbols nm -D --defined-only --demangle ${BINARY}/libplugin.so)
string(REGEX MATCHALL "[^\n]* [TBD] alpenglow::[^\n]*" leaked "${symbols}")  # W: inline, from the headers
if(leaked OR NOT symbols MATCHES "ZenithLuminance")
  message(FATAL_ERROR "libplugin.so exports\n${symbols}")
endif()
# A shared library exports public names only: none of a layer but the exceptions, which are declared there.
file(GLOB libraries ${PREFIX}/lib/*/libalpenglow_*.so ${PREFIX}/lib/libalpenglow_*.so)
foreach(library ${libraries})
  attempt(status symbols nm -D --defined-only --demangle ${library})
  string(REGEX MATCHALL "[^\n]* [TBDVWu] (alpenglow::(atmosphere|lut|renderer)::|fmt::|glm::)[^\n]*" leaked "${symbols}")
  list(FILTER leaked EXCLUDE REGEX "::(Input|Output|Internal)Error")
  if(leaked)
    list(JOIN leaked "\n" leaked)
    message(FATAL_ERROR "${library} exports\n${leaked}")
  endif()
endforeach()

# What follows does not depend on the build: one preset of tests/run.sh is enough.
if(NOT "${FLAGS}" STREQUAL "")
  return()
endif()

# The component lut is enough for tables, without what only renderer needs.
file(REMOVE_RECURSE ${BINARY}/lut)
run(${configure} -S ${SOURCE} -B ${BINARY}/lut -DCOMPONENTS=lut -DCMAKE_DISABLE_FIND_PACKAGE_GDAL=ON
  -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON -DCMAKE_DISABLE_FIND_PACKAGE_tinyxml2=ON)
run(${CMAKE_COMMAND} --build ${BINARY}/lut --target tables)

# Another component is refused by its name.
attempt(status output ${configure} -S ${SOURCE} -B ${BINARY}/unknown -DCOMPONENTS=clouds)
string(REGEX REPLACE "[ \n]+" " " output "${output}")  # the message is broken into lines
if(status EQUAL 0 OR NOT output MATCHES "no component clouds")
  message(FATAL_ERROR "component clouds: exit status ${status}\n${output}")
endif()

# pkg-config has the options of the compiler for each component.
find_program(pkg_config pkg-config REQUIRED)
file(GLOB packages ${PREFIX}/lib/pkgconfig ${PREFIX}/lib/*/pkgconfig)
set(ENV{PKG_CONFIG_PATH} ${packages})
foreach(example tables:alpenglow-lut still:alpenglow)
  string(REPLACE ":" ";" example ${example})
  list(GET example 0 program)
  list(GET example 1 package)
  execute_process(COMMAND ${pkg_config} --cflags --libs ${package} RESULT_VARIABLE status OUTPUT_VARIABLE options
    ERROR_VARIABLE message OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "pkg-config ${package}: ${message}")
  endif()
  separate_arguments(options UNIX_COMMAND "${options}")
  run(${COMPILER} -std=c++20 ${SOURCE}/${program}.cpp -o ${BINARY}/${program}_by_pkg_config ${options})
endforeach()

# Installed files do not name the folders of the build.
attempt(status named grep -rlF -e ${TREE}/ ${PREFIX})
if(NOT named STREQUAL "")
  message(FATAL_ERROR "these installed files contain ${TREE}/:\n${named}")
endif()
foreach(document LICENSE renderer/MANUAL.md atmosphere/ATMOSPHERE_FILE.md lut/ACCURACY.md)
  if(NOT EXISTS ${PREFIX}/share/doc/alpenglow/${document})
    message(FATAL_ERROR "${document} is not installed")
  endif()
endforeach()
