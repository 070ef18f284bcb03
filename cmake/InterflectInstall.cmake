# `cmake --install`: the command, the headers, and a package for find_package(interflect), target interflect::interflect.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/interflect)

install(TARGETS interflect_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS interflect_library EXPORT interflect ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
                                                      LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/interflect DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT interflect NAMESPACE interflect:: DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/interflect-config-version.cmake COMPATIBILITY SameMinorVersion)
configure_file(cmake/interflect-config.cmake.in interflect-config.cmake @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/interflect-config.cmake cmake/InterflectDependencies.cmake
              ${PROJECT_BINARY_DIR}/interflect-config-version.cmake
        DESTINATION ${package_folder})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/interflect)
