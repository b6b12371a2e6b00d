# Compile rules. Each set is an interface target that the libraries link.

# project_rules: for every source of the project (PUBLIC). Eigen's vector code is off: its order of summation and the
# layout of its types depend on the vector width. Contraction into fused multiply-add is off. Both are needed for equal
# float bits on every processor.
find_package(Eigen3 REQUIRED NO_MODULE)
add_library(project_rules INTERFACE)
target_link_libraries(project_rules INTERFACE Eigen3::Eigen)
target_include_directories(project_rules INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
  $<INSTALL_INTERFACE:include/tumblesight>)
target_compile_definitions(project_rules INTERFACE EIGEN_DONT_VECTORIZE
  TUMBLESIGHT_FLOAT32=$<BOOL:${TUMBLESIGHT_FLOAT32}>)
target_compile_options(project_rules INTERFACE -ffp-contract=off -fno-math-errno
  "$<BUILD_INTERFACE:-Wall;-Wextra;-Wshadow;-Wconversion;-Wno-sign-conversion;-Wno-float-conversion;-Wno-psabi>")
target_compile_features(project_rules INTERFACE cxx_std_17)

# flight_rules: for the sources of the flight side, in addition: no exceptions, no RTTI, no heap. PRIVATE, so that
# programs that link the libraries are free of them.
add_library(flight_rules INTERFACE)
target_compile_options(flight_rules INTERFACE -ffunction-sections -fdata-sections
  $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions -fno-rtti -fno-threadsafe-statics>)
target_compile_definitions(flight_rules INTERFACE EIGEN_NO_MALLOC EIGEN_NO_IO)
# The call graph with the stack use of each function, written beside each object file: for tests/audit.
if(CMAKE_CROSSCOMPILING AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(flight_rules INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fcallgraph-info=su>)
endif()

# tool_rules: for code of the ground whose speed does not matter, in addition. Less optimization: the command line compiles in two
# thirds of the time. PRIVATE.
add_library(tool_rules INTERFACE)
target_compile_options(tool_rules INTERFACE $<$<CONFIG:Release>:-O1>)
