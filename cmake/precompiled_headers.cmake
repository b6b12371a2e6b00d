# Headers that take longer to read than most sources take to compile are compiled once, for all libraries that have the same
# rules.

# add_precompiled_headers(<name> RULES <target>... HEADERS <header>...)
# RULES: what the libraries link that decides how a header is read: options, among them the level of optimization, and
# definitions.
function(add_precompiled_headers name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "RULES;HEADERS")
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Only its precompiled headers are used.\n")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE project_rules ${arg_RULES})
  set_property(TARGET ${name} PROPERTY TUMBLESIGHT_RULES ${arg_RULES})
  target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
  # ccache takes a precompiled header's includes from the output of the preprocessor.
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()

# use_precompiled_headers(<name> <target>...): the targets get the rules as well.
function(use_precompiled_headers name)
  get_property(rules TARGET ${name} PROPERTY TUMBLESIGHT_RULES)
  foreach(target ${ARGN})
    target_link_libraries(${target} PRIVATE ${rules})
    target_precompile_headers(${target} REUSE_FROM ${name})
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  endforeach()
endfunction()

# compile_with_headers(<library> <name> <source>...): adds sources to a library that use other precompiled headers than the rest
# of it. After what the library links.
function(compile_with_headers library name)
  set(objects ${library}_with_${name})
  add_library(${objects} OBJECT ${ARGN})
  get_target_property(libraries ${library} LINK_LIBRARIES)
  target_link_libraries(${objects} PRIVATE ${libraries})
  get_target_property(definitions ${library} COMPILE_DEFINITIONS)
  if(definitions)
    target_compile_definitions(${objects} PRIVATE ${definitions})
  endif()
  use_precompiled_headers(${name} ${objects})
  target_sources(${library} PRIVATE $<TARGET_OBJECTS:${objects}>)
endfunction()
