# A kernel's object (atmosphere/shared_glsl/instruction_set.h) may define for the whole program only its own tables
# and templates that carry its instruction set in their names: a weak symbol of any other name could
# be the copy that the linker takes for code that must run on every processor.
#   cmake -DNM=nm -DOBJECTS=a.o;b.o -DOWN=avx2 -P kernel_symbols.cmake
foreach(object ${OBJECTS})
  execute_process(COMMAND ${NM} -C --defined-only --extern-only ${object}
    OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE ";" "," symbols "${symbols}")
  string(REPLACE "\n" ";" symbols "${symbols}")
  set(tables 0)
  foreach(symbol ${symbols})
    if(symbol MATCHES "DW.ref.__gxx_personality_v0")  # data: where the handler of exceptions is
    elseif(symbol MATCHES "KernelOf\\(")
      math(EXPR tables "${tables} + 1")
    elseif(NOT symbol MATCHES "xsimd::([a-z0-9]+<)?${OWN}")
      message(SEND_ERROR "${object} defines ${symbol}")
    endif()
  endforeach()
  if(tables EQUAL 0)
    message(SEND_ERROR "${object} defines no table")
  endif()
endforeach()
