# interflect_compiler_cache: launcher that takes from ccache what it has compiled before in any clone or branch, if ccache
# is installed. Only for targets without precompiled headers, which contain paths and times of their clone: the folders of
# the library compiled by GCC.
option(INTERFLECT_CCACHE "Compile the library through ccache, if it is installed" ${PROJECT_IS_TOP_LEVEL})
if(INTERFLECT_CCACHE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  find_program(INTERFLECT_CCACHE_PROGRAM ccache)
  if(INTERFLECT_CCACHE_PROGRAM)
    # Paths of this clone count as relative to it.
    set(interflect_compiler_cache ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
                                  ${INTERFLECT_CCACHE_PROGRAM})
  endif()
endif()
