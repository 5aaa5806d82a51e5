# cmake --install: the program, the library with its public headers and CMake package, and the built-in scene.
# The bundle target makes one self-contained tarball beside it.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS heliodon EXPORT heliodonTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development)
install(TARGETS heliodon_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/assets DESTINATION share/heliodon COMPONENT runtime)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION share/heliodon COMPONENT runtime)

# The public API, and for writing passes the frame graph, the Vulkan layer and the two-language formulas. What a
# room keeps to itself stays out.
install(FILES ${PROJECT_SOURCE_DIR}/include/heliodon/heliodon.h DESTINATION include/heliodon COMPONENT development)
foreach(ROOM core scene gpu graph shading)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/${ROOM} DESTINATION include/heliodon COMPONENT development
    FILES_MATCHING PATTERN "*.h")
endforeach()
foreach(HEADER import/import.h trace/path_tracer.h realtime/renderer.h realtime/shadow_volume_statistics.h)
  get_filename_component(ROOM ${HEADER} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/src/${HEADER} DESTINATION include/heliodon/${ROOM} COMPONENT development)
endforeach()

set(PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/heliodon)
install(EXPORT heliodonTargets NAMESPACE heliodon:: DESTINATION ${PACKAGE_DIR} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/heliodonConfig.cmake.in
  ${PROJECT_BINARY_DIR}/heliodonConfig.cmake INSTALL_DESTINATION ${PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/heliodonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/heliodonConfig.cmake ${PROJECT_BINARY_DIR}/heliodonConfigVersion.cmake
  DESTINATION ${PACKAGE_DIR} COMPONENT development)

# The bundle: bin/heliodon starts libexec/heliodon, which finds lib/ by its RPATH (and so do the libraries below
# it, which is why it is an RPATH and not a RUNPATH). Base libraries that a Vulkan driver or a desktop brings
# along go to lib/base: an older copy in front of the system's would keep the driver from loading, so
# bin/heliodon takes them only where the system has none.
install(PROGRAMS ${PROJECT_SOURCE_DIR}/scripts/bundle-start.sh DESTINATION bin RENAME heliodon
  COMPONENT bundle EXCLUDE_FROM_ALL)
install(PROGRAMS $<TARGET_FILE:heliodon_cli> DESTINATION libexec COMPONENT bundle EXCLUDE_FROM_ALL)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION share/heliodon COMPONENT bundle EXCLUDE_FROM_ALL)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/assets DESTINATION share/heliodon COMPONENT bundle EXCLUDE_FROM_ALL)
install(CODE "set(PROGRAM \"$<TARGET_FILE:heliodon_cli>\")
set(LIBRARY \"$<TARGET_FILE:heliodon>\")
set(VULKAN_LOADER \"${Vulkan_LIBRARY}\")"
  COMPONENT bundle EXCLUDE_FROM_ALL)
install(SCRIPT ${PROJECT_SOURCE_DIR}/cmake/BundleLibraries.cmake COMPONENT bundle EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR TGZ)
set(CPACK_PACKAGE_NAME heliodon)
set(CPACK_PACKAGE_FILE_NAME heliodon-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_COMPONENTS_ALL bundle)
set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
include(CPack)
add_custom_target(bundle
  COMMAND ${CMAKE_CPACK_COMMAND} --config ${PROJECT_BINARY_DIR}/CPackConfig.cmake -B ${PROJECT_BINARY_DIR}
  DEPENDS heliodon_cli USES_TERMINAL VERBATIM)
