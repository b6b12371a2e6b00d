# What a toolchain file cannot do without; says which package brings it.
function(require_program variable name package)
  find_program(${variable} ${name})
  if(NOT ${variable})
    message(FATAL_ERROR "${CMAKE_CURRENT_LIST_FILE}\n  needs ${name}; on Debian: apt-get install ${package}")
  endif()
endfunction()
