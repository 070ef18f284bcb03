# `cmake --install`: the command, the headers, and a package for find_package(interflect), target interflect::interflect.
# Each component is a Debian package (packaging/CMakeLists.txt), except the licence, which Debian has already.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/interflect)

install(TARGETS interflect_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/interflect COMPONENT command)
install(DIRECTORY integrations/blender/interflect DESTINATION ${CMAKE_INSTALL_DATADIR}/blender/scripts/addons
        COMPONENT command PATTERN __pycache__ EXCLUDE)

install(TARGETS interflect_library EXPORT interflect
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT command NAMELINK_COMPONENT development)
install(DIRECTORY include/interflect DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.h")
install(EXPORT interflect NAMESPACE interflect:: DESTINATION ${package_folder} COMPONENT development)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/interflect-config-version.cmake COMPATIBILITY SameMinorVersion)
configure_file(cmake/interflect-config.cmake.in interflect-config.cmake @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/interflect-config.cmake cmake/InterflectDependencies.cmake
              ${PROJECT_BINARY_DIR}/interflect-config-version.cmake
        DESTINATION ${package_folder} COMPONENT development)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/interflect COMPONENT licence)
