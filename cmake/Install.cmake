# What cmake --install lays down: the program with its species, and the simulator as a package for find_package(liana).
include(CMakePackageConfigHelpers)
install(TARGETS liana RUNTIME DESTINATION bin COMPONENT program)
install(DIRECTORY data/species DESTINATION share/liana COMPONENT program)
install(TARGETS liana_options EXPORT liana COMPONENT library)
install(EXPORT liana NAMESPACE liana:: DESTINATION lib/cmake/liana FILE targets.cmake COMPONENT library)
install(FILES cmake/liana-config.cmake DESTINATION lib/cmake/liana COMPONENT library)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/liana-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/liana-config-version.cmake DESTINATION lib/cmake/liana COMPONENT library)
