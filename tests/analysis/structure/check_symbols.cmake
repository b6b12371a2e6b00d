# Checks with nm the symbols that the flight libraries need from outside.
#   cmake -DNM=<nm> -DLIBRARIES=<a.a;b.o> [-DONLY_HEAP=ON] [-DMUST_CATCH=<symbol;...>] -P check_symbols.cmake
# Fails if a symbol is forbidden on the flight side. With ONLY_HEAP it looks for the heap only: platforms and programs may
# use their system. With MUST_CATCH it passes only if every symbol named there is caught: this tests the check itself.

cmake_minimum_required(VERSION 3.25)

# The only symbols that flight code may need from outside: functions that the compiler calls by itself, square roots, the
# detection of the processor's vector units, and Eigen's assertions in debug builds.
set(allowed "^(memcpy|memmove|memset|memcmp|strlen|strcmp|strncmp|sqrtf?|abort)$"
  "^(__stack_chk_fail|__assert_fail|_GLOBAL_OFFSET_TABLE_|__dso_handle|__cpu_model|__cpu_features2|__cpu_indicator_init)$"
  "^__(asan|ubsan|tsan|sanitizer|gcov|gcc_personality)_")
# Forbidden even if the library defines them itself.
set(heap "^(malloc|calloc|realloc|free|aligned_alloc|posix_memalign)$" "^_Zn[aw]" "^_Zd[al]"
  "^_?_?(strn?dup|v?asprintf|f?open_?memstream|f(d|re)?open|tmpfile|getline|getdelim|(fd)?opendir|scandir|realpath|dlopen)(64)?$"
  "^_ZNK?S[st].*basic_string" "^_ZNK?S[st].*basic_[io]?f(stream|ilebuf)" "^_ZNK?St.*stringstream" "^_ZNSt6locale")
set(never ${heap} "^_ZT[IS]" "^__cxa_"
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

set(forbidden_symbols ${never})
if(ONLY_HEAP)
  set(forbidden_symbols ${heap})
endif()

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
  matches_any("${symbol}" forbidden ${forbidden_symbols})
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

# A symbol that one of the libraries needs from another one is checked there.
list(REMOVE_DUPLICATES undefined)
list(REMOVE_ITEM undefined ${defined_somewhere})
if(NOT ONLY_HEAP)
  foreach(symbol IN LISTS undefined)
    matches_any("${symbol}" fine ${allowed})
    if(NOT fine)
      list(APPEND caught ${symbol})
    endif()
  endforeach()
endif()
list(REMOVE_DUPLICATES caught)

if(DEFINED MUST_CATCH)
  foreach(symbol IN LISTS MUST_CATCH)
    if(NOT symbol IN_LIST caught)
      message(FATAL_ERROR "${symbol} was not caught; caught: ${caught}")
    endif()
  endforeach()
  message(STATUS "caught as expected: ${caught}")
elseif(caught)
  list(JOIN caught "\n  " caught)
  message(FATAL_ERROR "forbidden on the flight side:\n  ${caught}\nin ${LIBRARIES}")
else()
  message(STATUS "${looked_at} symbols checked in ${LIBRARIES}")
endif()
