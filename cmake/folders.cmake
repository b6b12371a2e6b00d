# project_folders: where the programs find the files that ship with them. TUMBLESIGHT_INSTALLED_DATA is the data folder of an
# installed program, relative to the folder of the program; TUMBLESIGHT_SOURCE_LINK, also relative to it, is a link in the build
# folder to the source tree, which all others use. So no program contains a path of the machine that built it.
include(GNUInstallDirs)
file(RELATIVE_PATH installed_data ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/tumblesight)
add_library(project_folders INTERFACE)
target_compile_definitions(project_folders INTERFACE TUMBLESIGHT_INSTALLED_DATA="${installed_data}"
  TUMBLESIGHT_SOURCE_LINK="../source_tree")
# A build folder within the source tree can be moved with it.
set(source_tree ${PROJECT_SOURCE_DIR})
cmake_path(IS_PREFIX source_tree ${PROJECT_BINARY_DIR} is_within)
if(is_within)
  file(RELATIVE_PATH source_tree ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR})
endif()
file(CREATE_LINK ${source_tree} ${PROJECT_BINARY_DIR}/source_tree SYMBOLIC)
