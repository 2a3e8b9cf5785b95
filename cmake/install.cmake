# What `cmake --install` puts down: headers, library, and the files by which CMake and pkg-config find them.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/carom)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(TARGETS carom EXPORT carom FILE_SET HEADERS)
install(EXPORT carom NAMESPACE carom:: FILE caromTargets.cmake DESTINATION ${package_dir})
configure_file(${CMAKE_CURRENT_LIST_DIR}/caromConfig.cmake.in ${PROJECT_BINARY_DIR}/caromConfig.cmake @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/caromConfig.cmake DESTINATION ${package_dir})

write_basic_package_version_file(${PROJECT_BINARY_DIR}/caromConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/caromConfigVersion.cmake DESTINATION ${package_dir})

# The way from carom.pc back to the prefix, so that an installed tree can be moved.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX
    BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}/${pkgconfig_dir}
    OUTPUT_VARIABLE prefix_from_pkgconfig)
set(carom_pc_requires libhwy)
if(CAROM_TBB)
    set(carom_pc_requires "libhwy, tbb")
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/carom.pc.in ${PROJECT_BINARY_DIR}/carom.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/carom.pc DESTINATION ${pkgconfig_dir})
