# `cmake --install`: both libraries, the header, the CMake package and the pkg-config file, all relocatable.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(PROGRAMS "${PROJECT_BINARY_DIR}/lib/${GNOMON_SHARED_FILE}" DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES "${PROJECT_BINARY_DIR}/lib/${GNOMON_SONAME}" "${PROJECT_BINARY_DIR}/lib/libgnomon.so"
              "${PROJECT_BINARY_DIR}/lib/libgnomon.a"
        DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES "${PROJECT_SOURCE_DIR}/include/gnomon.h" DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gnomon)
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/gnomonConfig.cmake.in" "${PROJECT_BINARY_DIR}/gnomonConfig.cmake"
                              INSTALL_DESTINATION ${package_dir}
                              PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR)
# Until version 1 a minor version may change the interface.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/gnomonConfig.cmake" "${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake"
        DESTINATION ${package_dir})

set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_pkgconfig_dir "/prefix/${pkgconfig_dir}" "/prefix")
string(REGEX REPLACE "/$" "" prefix_from_pkgconfig_dir "${prefix_from_pkgconfig_dir}")
list(TRANSFORM GNOMON_STATIC_DEPENDENCIES PREPEND "-l" OUTPUT_VARIABLE static_dependency_flags)
list(JOIN static_dependency_flags " " static_dependency_flags)
configure_file(cmake/gnomon.pc.in "${PROJECT_BINARY_DIR}/gnomon.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/gnomon.pc" DESTINATION ${pkgconfig_dir})
