# Finds a program that a toolchain file needs, or stops with the name of its Debian package. cmake/setup.sh reads these
# lines to install the packages.
function(require_program variable name package)
  find_program(${variable} ${name})
  if(NOT ${variable})
    message(FATAL_ERROR "${CMAKE_CURRENT_LIST_FILE}\n  needs ${name}; on Debian: apt-get install ${package}")
  endif()
endfunction()
