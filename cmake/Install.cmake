# The program, the library with its header, and what loads image files; find_package(lambert) works from here and from the build.
include(CMakePackageConfigHelpers)

set_target_properties(lambert PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/lambert")
install(TARGETS lambert RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS lambert_images LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/lambert)
install(TARGETS lambert_shared EXPORT lambertTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES library/lambert.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lambert)
install(EXPORT lambertTargets NAMESPACE lambert:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lambert)
export(EXPORT lambertTargets NAMESPACE lambert:: FILE ${PROJECT_BINARY_DIR}/lambertTargets.cmake)

configure_package_config_file(cmake/lambertConfig.cmake.in ${PROJECT_BINARY_DIR}/lambertConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lambert)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lambertConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lambertConfig.cmake ${PROJECT_BINARY_DIR}/lambertConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lambert)
