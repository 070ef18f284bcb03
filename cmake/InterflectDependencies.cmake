# What the library links to; found alike when it is built and when it is used from an installed package.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(TBB)
find_dependency(Imath 3.1)
find_dependency(OpenEXR 3.1)
find_dependency(fmt)
find_dependency(nlohmann_json)
if(INTERFLECT_MPI)
  find_dependency(MPI COMPONENTS CXX)
endif()
# Debian 12 has Embree 3; the one file that calls it (raycast/ray_caster.cpp) compiles against Embree 4 as well.
find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
  find_dependency(embree 3)
endif()

# interflect_find_library(TARGET HEADER header LIBRARY names... [FOLDERS suffixes...]): an imported library, so that what
# is installed names no path of this machine.
function(interflect_find_library target)
  cmake_parse_arguments(arg "" "HEADER" "LIBRARY;FOLDERS" ${ARGN})
  if(TARGET ${target})
    return()
  endif()
  string(MAKE_C_IDENTIFIER ${target} name)
  find_path(${name}_INCLUDE ${arg_HEADER} PATH_SUFFIXES ${arg_FOLDERS} REQUIRED)
  find_library(${name}_LIBRARY NAMES ${arg_LIBRARY} PATH_SUFFIXES ${arg_FOLDERS} REQUIRED)
  add_library(${target} UNKNOWN IMPORTED)
  set_target_properties(${target} PROPERTIES IMPORTED_LOCATION ${${name}_LIBRARY}
                                             INTERFACE_INCLUDE_DIRECTORIES ${${name}_INCLUDE})
endfunction()

interflect_find_library(interflect::glu HEADER GL/glu.h LIBRARY GLU)
# CMake's own FindHDF5 asks the compiler of C, which a project need not have enabled.
interflect_find_library(interflect::hdf5 HEADER hdf5.h LIBRARY hdf5 hdf5_serial FOLDERS hdf5/serial)
interflect_find_library(interflect::deflate HEADER libdeflate.h LIBRARY deflate)
interflect_find_library(interflect::spng HEADER spng.h LIBRARY spng)
interflect_find_library(interflect::turbojpeg HEADER turbojpeg.h LIBRARY turbojpeg)
interflect_find_library(interflect::meshoptimizer HEADER meshoptimizer.h LIBRARY meshoptimizer)
interflect_find_library(interflect::draco HEADER draco/compression/decode.h LIBRARY draco)
interflect_find_library(interflect::zip HEADER zip.h LIBRARY zip)
