# Installs `build` below `work`, moves the installation, builds the project `consumer` against it alone, and runs it.
# cmake -D build=... -D consumer=... -D work=... -D generator=... -D compiler=... -D configuration=... -P check_package.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${work})
run(${CMAKE_COMMAND} --install ${build} --prefix ${work}/first --config ${configuration})
set(prefix ${work}/moved)  # the installation works from any folder
file(RENAME ${work}/first ${prefix})

file(GLOB_RECURSE package_files ${prefix}/lib*/cmake/*.cmake)
foreach(file ${package_files})
  file(STRINGS ${file} paths REGEX "[\"; :]/(usr|home|tmp|work|opt)/|${work}|${build}")
  if(paths)
    message(FATAL_ERROR "${file} names a path of this machine: ${paths}")
  endif()
endforeach()

run(${prefix}/bin/interflect --version)
# The README's example, as printed.
file(READ ${consumer}/../../../README.md readme)
string(REGEX MATCH "```cpp\n(#include[^`]*)```" found "${readme}")
if(NOT found)
  message(FATAL_ERROR "the README has no complete program")
endif()
file(WRITE ${work}/readme.cpp "${CMAKE_MATCH_1}")

run(${CMAKE_COMMAND} -D readme_program=${work}/readme.cpp -S ${consumer} -B ${work}/build -G ${generator} -D CMAKE_BUILD_TYPE=${configuration}
    -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${work}/build --config ${configuration})
run(${work}/build/consumer)
