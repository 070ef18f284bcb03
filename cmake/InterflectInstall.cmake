# `cmake --install`: the command, the headers, and a package for find_package(interflect), target interflect::interflect.
include(CMakePackageConfigHelpers)
get_property(interflect_targets GLOBAL PROPERTY interflect_targets)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/interflect)

install(TARGETS interflect_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS interflect_library ${interflect_targets} EXPORT interflect ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY src/interflect DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT interflect NAMESPACE interflect:: DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/interflect-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/interflect-config.cmake cmake/InterflectDependencies.cmake
              ${PROJECT_BINARY_DIR}/interflect-config-version.cmake
        DESTINATION ${package_folder})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/interflect)
