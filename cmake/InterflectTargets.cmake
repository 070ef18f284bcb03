# interflect_folder(NAME SOURCES ... USES other folders ... LINKS libraries ... [PRIVATE_LINKS libraries ...]):
# the objects of a folder of src/interflect. USES names only folders above it in docs/develop/architecture.md's table.

set(interflect_warnings -Wall -Wextra -Wconversion -Wno-sign-conversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  list(APPEND interflect_warnings -Wno-restrict)  # false alarms of GCC 12 in std::string (its bug 105651)
endif()
if(INTERFLECT_WERROR)
  list(APPEND interflect_warnings -Werror)
endif()

add_library(interflect_options INTERFACE)
target_compile_features(interflect_options INTERFACE cxx_std_20)
# In a unit of several files of tests, local names shadow those of other files.
target_compile_options(interflect_options INTERFACE $<$<NOT:$<BOOL:$<TARGET_PROPERTY:INTERFLECT_TEST>>>:-Wshadow>)
# Without errno, and traps that nobody sets, square roots and choices become vector code.
target_compile_options(interflect_options INTERFACE ${interflect_warnings} -fno-math-errno -fno-trapping-math)
# The same expression rounds alike wherever it is compiled; fused multiply-adds would differ between copies of a loop, and
# resumed runs from runs that never stopped.
target_compile_options(interflect_options INTERFACE -ffp-contract=off)
if(INTERFLECT_ARCH)
  target_compile_options(interflect_options INTERFACE -march=${INTERFLECT_ARCH})
endif()
if(INTERFLECT_SANITIZE)
  target_compile_options(interflect_options INTERFACE -fsanitize=${INTERFLECT_SANITIZE} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all)
  if(INTERFLECT_SANITIZE MATCHES address)  # it finds such accesses itself; these checks build slowly
    target_compile_options(interflect_options INTERFACE -fno-sanitize=null,object-size)
  endif()
  target_link_options(interflect_options INTERFACE -fsanitize=${INTERFLECT_SANITIZE})
endif()

function(interflect_folder name)
  cmake_parse_arguments(arg "" "" "SOURCES;USES;LINKS;PRIVATE_LINKS" ${ARGN})
  set(target interflect_${name})
  add_library(${target} OBJECT ${arg_SOURCES})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON UNITY_BUILD ${INTERFLECT_UNITY}
                        CXX_COMPILER_LAUNCHER "${interflect_compiler_cache}")
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  list(TRANSFORM arg_USES PREPEND interflect_)
  target_link_libraries(${target} PUBLIC ${arg_USES} ${arg_LINKS} PRIVATE interflect_options ${arg_PRIVATE_LINKS})
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang)  # GCC 12 has false alarms in what is precompiled
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <functional> <memory> <span>
                              <string> <vector> <ImathVec.h>)
  endif()
  list(TRANSFORM arg_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  set_property(GLOBAL APPEND PROPERTY interflect_sources ${arg_SOURCES})
  set_property(GLOBAL APPEND PROPERTY interflect_folders ${target})
  set_property(GLOBAL APPEND PROPERTY interflect_public_links ${arg_LINKS})
  set_property(GLOBAL APPEND PROPERTY interflect_links ${arg_LINKS} ${arg_PRIVATE_LINKS})
endfunction()
