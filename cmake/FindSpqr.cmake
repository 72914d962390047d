# SuiteSparse in Debian 12 ships no CMake package; gives the target Spqr::Spqr: SuiteSparseQR and CHOLMOD.
find_path(Spqr_INCLUDE_DIR SuiteSparseQR.hpp PATH_SUFFIXES suitesparse)
find_library(Spqr_LIBRARY spqr)
find_library(Spqr_CHOLMOD_LIBRARY cholmod)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Spqr REQUIRED_VARS Spqr_LIBRARY Spqr_CHOLMOD_LIBRARY
                                                     Spqr_INCLUDE_DIR)
if(Spqr_FOUND AND NOT TARGET Spqr::Spqr)
  add_library(Spqr::Spqr INTERFACE IMPORTED)
  target_include_directories(Spqr::Spqr SYSTEM INTERFACE ${Spqr_INCLUDE_DIR})
  target_link_libraries(Spqr::Spqr INTERFACE ${Spqr_LIBRARY} ${Spqr_CHOLMOD_LIBRARY})
endif()
