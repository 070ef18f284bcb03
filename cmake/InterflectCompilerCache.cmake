# Takes from ccache what it has compiled before in any clone or branch, if it is installed. GCC only: the precompiled
# headers of clang contain paths and times of their clone.
option(INTERFLECT_CCACHE "Compile through ccache, if it is installed" ${PROJECT_IS_TOP_LEVEL})
if(INTERFLECT_CCACHE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(INTERFLECT_CCACHE_PROGRAM ccache)
  if(INTERFLECT_CCACHE_PROGRAM)
    # Paths of this clone count as relative to it; precompiled headers need the sloppiness (manual of ccache).
    set(CMAKE_CXX_COMPILER_LAUNCHER
        ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
        CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${INTERFLECT_CCACHE_PROGRAM})
  endif()
endif()
