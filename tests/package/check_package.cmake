# Installs `build` below `work`, builds the project `consumer` against that and nothing else of ours, runs it.
# cmake -D build=... -D consumer=... -D work=... -D generator=... -D compiler=... -D configuration=... -P check_package.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${work})
set(prefix ${work}/prefix)
run(${CMAKE_COMMAND} --install ${build} --prefix ${prefix} --config ${configuration})
run(${prefix}/bin/interflect --version)
run(${CMAKE_COMMAND} -S ${consumer} -B ${work}/build -G ${generator} -D CMAKE_BUILD_TYPE=${configuration}
    -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${work}/build --config ${configuration})
run(${work}/build/consumer)
