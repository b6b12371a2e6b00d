# Two sets of compile rules, each an interface target that a folder's library links.

# Every source of the project (PUBLIC). Eigen without its own vector code: its summation order depends on the vector
# width, and so does the layout of its types, which both sides share. No contraction into fused multiply-add: the same
# float bits on every processor.
find_package(Eigen3 REQUIRED NO_MODULE)
add_library(project_rules INTERFACE)
target_link_libraries(project_rules INTERFACE Eigen3::Eigen)
target_include_directories(project_rules INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_definitions(project_rules INTERFACE EIGEN_DONT_VECTORIZE
  TUMBLESIGHT_FLOAT32=$<BOOL:${TUMBLESIGHT_FLOAT32}>)
target_compile_options(project_rules INTERFACE -ffp-contract=off -fno-math-errno -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
  -Wno-float-conversion -Wno-psabi)

# The flight side's sources, beside that (PRIVATE, so that programs which link them are not bound): no exceptions, no
# RTTI, no heap.
add_library(flight_rules INTERFACE)
target_compile_options(flight_rules INTERFACE -ffunction-sections -fdata-sections
  $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions -fno-rtti -fno-threadsafe-statics>)
target_compile_definitions(flight_rules INTERFACE EIGEN_NO_MALLOC EIGEN_NO_IO)
# Who calls whom with how much stack, beside each object file: for the audit (tests/audit).
if(CMAKE_CROSSCOMPILING AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(flight_rules INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fcallgraph-info=su>)
endif()
