include(${CMAKE_CURRENT_LIST_DIR}/InterflectDependencies.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/interflect.cmake)
