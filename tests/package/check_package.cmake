# Installs `build` below `work`, moves the installation, builds examples/cpp and `consumer` against it alone, and runs the latter.
# cmake -D build=... -D source=... -D work=... -D generator=... -D compiler=... -D configuration=... -P check_package.cmake
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
# The README prints the example.
file(READ ${source}/README.md readme)
file(STRINGS ${source}/examples/cpp/office.cpp example REGEX "^[^/]")
foreach(line IN LISTS example)
  string(FIND "${readme}" "${line}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "README.md lacks this line of examples/cpp/office.cpp: ${line}")
  endif()
endforeach()

foreach(project examples/cpp tests/package/consumer)
  run(${CMAKE_COMMAND} -S ${source}/${project} -B ${work}/${project} -G ${generator} -D CMAKE_BUILD_TYPE=${configuration}
      -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_PREFIX_PATH=${prefix})
  run(${CMAKE_COMMAND} --build ${work}/${project} --config ${configuration})
endforeach()
run(${work}/tests/package/consumer/consumer)
