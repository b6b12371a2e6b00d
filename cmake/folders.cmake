# project_folders: where the programs find the files that ship with them. TUMBLESIGHT_INSTALLED_DATA is the data folder of an
# installed program, relative to the folder of the program; TUMBLESIGHT_SOURCE_DIR is the tree that all others use.
include(GNUInstallDirs)
file(RELATIVE_PATH installed_data ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/tumblesight)
add_library(project_folders INTERFACE)
target_compile_definitions(project_folders INTERFACE TUMBLESIGHT_INSTALLED_DATA="${installed_data}"
  TUMBLESIGHT_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
