# strongpoint_read_def(VARIABLE FILE): the names listed in a .def file, one NAME per line as KIND(NAME).
# The file is watched, so that a new line reconfigures the build.
function(strongpoint_read_def variable file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(STRINGS ${file} lines REGEX "^[A-Z]+\\([a-z0-9_]+\\)")
  set(names "")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^[A-Z]+\\(([a-z0-9_]+)\\).*" "\\1" name "${line}")
    list(APPEND names ${name})
  endforeach()
  set(${variable} ${names} PARENT_SCOPE)
endfunction()

# strongpoint_options(TARGET): warnings and numerics flags shared by every target.
function(strongpoint_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                           -ffp-contract=off)
  if(STRONGPOINT_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# strongpoint_check_headers(): a target that compiles each of our headers alone.
function(strongpoint_check_headers)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR} methods/*.hpp problems/*.hpp
       studies/*.hpp bench/*.hpp tests/*.hpp)
  set(sources "")
  foreach(header IN LISTS headers)
    set(source ${CMAKE_BINARY_DIR}/header_check/${header}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n")
    list(APPEND sources ${source})
  endforeach()
  add_library(header_check OBJECT ${sources})
  target_link_libraries(header_check PRIVATE strongpoint_studies GTest::gtest)
  strongpoint_options(header_check)
endfunction()
