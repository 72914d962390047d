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

# strongpoint_simd_sources(TARGET FILE...): compiles kernel sources once per path and adds them to a target
# (methods/core/simd/path.hpp).
function(strongpoint_simd_sources target)
  set(paths scalar)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
    list(APPEND paths avx2 avx512)
  endif()
  set(flags_of_avx2 -mavx2 -mfma)
  set(flags_of_avx512 -mavx512f -mavx512dq -mavx512vl -mfma -mprefer-vector-width=512)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # its own headers begin with undefined registers (GCC bug 105593)
    list(APPEND flags_of_avx512 -Wno-uninitialized -Wno-maybe-uninitialized)
  endif()
  set(flags_of_compiler -ffp-contract=fast)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    # Its `fast` contracts across statements as far as it inlined, so that bits would depend on how many derivatives
    # are asked for. Unrolled and instrumented, a kernel would take it minutes.
    set(flags_of_compiler -ffp-contract=on -Wno-pass-failed
                          "$<$<CONFIG:Debug>:SHELL:-mllvm -pragma-unroll-threshold=0>")
  endif()
  foreach(path IN LISTS paths)
    set(name ${target}_${path})
    add_library(${name} OBJECT ${ARGN})
    target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR})
    target_compile_features(${name} PRIVATE cxx_std_20)
    strongpoint_options(${name})
    target_compile_options(${name} PRIVATE ${flags_of_${path}} ${flags_of_compiler}
                           -fno-math-errno)
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${name}>)
  endforeach()
endfunction()
