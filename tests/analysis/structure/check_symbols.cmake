# Looks with nm at what flight libraries need from outside.
#   cmake -DNM=<nm> -DLIBRARIES=<a.a;b.a> [-DMUST_CATCH=<symbol;...>] -P check_symbols.cmake
# Fails when a symbol breaks the rules of the flight side. With MUST_CATCH it passes only if every symbol named there is
# caught: the check of this check.

cmake_minimum_required(VERSION 3.25)

# All that flight code may take from outside itself: what the compiler calls on its own, square roots, the list of the
# processor's vector units, and Eigen's assertions in debug builds.
set(allowed "^(memcpy|memmove|memset|memcmp|strlen|strcmp|strncmp|sqrtf?|abort)$"
  "^(__stack_chk_fail|__assert_fail|_GLOBAL_OFFSET_TABLE_|__dso_handle|__cpu_model|__cpu_features2|__cpu_indicator_init)$"
  "^__(asan|ubsan|tsan|sanitizer|gcov|gcc_personality)_")
# Never, not even defined in the library itself.
set(never "^_ZT[IS]" "^(malloc|calloc|realloc|free|aligned_alloc|posix_memalign)$" "^_Zn[aw]" "^_Zd[al]" "^__cxa_"
  "^_?_?(v?f?s?n?printf|puts|putchar|fwrite|fputs)" "^dds_"
  "^_?_?(exp|exp2|expm1|log|log2|log10|log1p|pow|sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|cbrt|hypot|erf|fmod)[fl]?(_finite)?$")

function(matches_any symbol result)
  set(${result} FALSE PARENT_SCOPE)
  foreach(pattern IN LISTS ARGN)
    if(symbol MATCHES "${pattern}")
      set(${result} TRUE PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

set(defined_somewhere "")
set(all_lines "")
foreach(library IN LISTS LIBRARIES)
  execute_process(COMMAND ${NM} -P ${library} OUTPUT_VARIABLE output RESULT_VARIABLE result ERROR_VARIABLE error)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${NM} ${library}: ${error}")
  endif()
  string(REGEX MATCHALL "[^\n]+" lines "${output}")
  list(APPEND all_lines ${lines})
endforeach()
list(REMOVE_DUPLICATES all_lines)

set(looked_at 0)
set(undefined "")
set(caught "")
foreach(line IN LISTS all_lines)
  if(NOT line MATCHES "^([^ ]+) ([A-Za-z])( |$)")
    continue()
  endif()
  set(symbol ${CMAKE_MATCH_1})
  set(kind ${CMAKE_MATCH_2})
  math(EXPR looked_at "${looked_at} + 1")
  matches_any("${symbol}" forbidden ${never})
  if(forbidden)
    list(APPEND caught ${symbol})
  elseif(kind MATCHES "^[Uw]$")
    list(APPEND undefined ${symbol})
  else()
    list(APPEND defined_somewhere ${symbol})
  endif()
endforeach()
if(looked_at EQUAL 0)
  message(FATAL_ERROR "no symbols found in ${LIBRARIES}")
endif()

# What one of the libraries takes from another of them is looked at there.
list(REMOVE_DUPLICATES undefined)
list(REMOVE_ITEM undefined ${defined_somewhere})
foreach(symbol IN LISTS undefined)
  matches_any("${symbol}" fine ${allowed})
  if(NOT fine)
    list(APPEND caught ${symbol})
  endif()
endforeach()
list(REMOVE_DUPLICATES caught)

if(DEFINED MUST_CATCH)
  foreach(symbol IN LISTS MUST_CATCH)
    if(NOT symbol IN_LIST caught)
      message(FATAL_ERROR "${symbol} was not caught; caught: ${caught}")
    endif()
  endforeach()
  message(STATUS "caught, as it should be: ${caught}")
elseif(caught)
  list(JOIN caught "\n  " caught)
  message(FATAL_ERROR "not for the flight side:\n  ${caught}\nin ${LIBRARIES}")
else()
  message(STATUS "${looked_at} symbols looked at in ${LIBRARIES}")
endif()
