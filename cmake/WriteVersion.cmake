# cmake -D SOURCE_DIR=... -D OUTPUT=... -P WriteVersion.cmake: writes the version of the code into
# OUTPUT, which is touched only when the version changed. The version is `git describe`; while the code
# differs from what is committed, `-dirty-` and a hash of the sources follow. Without git it is the
# hash. Tables and documents are not code: writing results does not change the version.
set(code_paths methods problems studies cmake CMakeLists.txt)

# Sets `variable` to the output of a git command in SOURCE_DIR, or to "" when it fails.
function(git variable)
  execute_process(COMMAND git ${ARGN} WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE output
                  ERROR_QUIET RESULT_VARIABLE status OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT status EQUAL 0)
    set(output "")
  endif()
  set(${variable} "${output}" PARENT_SCOPE)
endfunction()

# Sets `variable` to ten digits that change with any source file.
function(hash_sources variable)
  set(listing "")
  foreach(path IN LISTS code_paths)
    set(files ${path})
    if(IS_DIRECTORY ${SOURCE_DIR}/${path})
      file(GLOB_RECURSE files RELATIVE ${SOURCE_DIR} ${SOURCE_DIR}/${path}/*.cpp
           ${SOURCE_DIR}/${path}/*.hpp ${SOURCE_DIR}/${path}/*.def ${SOURCE_DIR}/${path}/*.in
           ${SOURCE_DIR}/${path}/*.cmake ${SOURCE_DIR}/${path}/CMakeLists.txt)
    endif()
    foreach(file IN LISTS files)
      file(SHA256 ${SOURCE_DIR}/${file} hash)
      string(APPEND listing "${file} ${hash}\n")
    endforeach()
  endforeach()
  string(SHA256 hash "${listing}")
  string(SUBSTRING ${hash} 0 10 hash)
  set(${variable} ${hash} PARENT_SCOPE)
endfunction()

hash_sources(hash)
set(STRONGPOINT_CODE_VERSION source-${hash})
# A repository that merely surrounds an unpacked archive says nothing about it.
git(top_level rev-parse --show-toplevel)
file(REAL_PATH ${SOURCE_DIR} source_dir)
if(top_level STREQUAL source_dir)
  git(description describe --always)
  git(changes status --porcelain -- ${code_paths})
  if(description AND changes)
    set(STRONGPOINT_CODE_VERSION ${description}-dirty-${hash})
  elseif(description)
    set(STRONGPOINT_CODE_VERSION ${description})
  endif()
endif()
configure_file(${SOURCE_DIR}/studies/support/version.cpp.in ${OUTPUT} @ONLY)
