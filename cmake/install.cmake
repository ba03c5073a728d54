# What `cmake --install` puts where, and the package that find_package(mien) finds:
#   mien::mien    the whole library
#   mien::<room>  one room and what it uses
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY MIEN_ROOMS)
list(TRANSFORM rooms PREPEND mien_ OUTPUT_VARIABLE room_targets)

# The program has the name mien already; users of the package see this target as mien::mien.
add_library(mien_library INTERFACE)
add_library(mien::mien ALIAS mien_library)
set_property(TARGET mien_library PROPERTY EXPORT_NAME mien)
target_link_libraries(mien_library INTERFACE ${room_targets})

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/mien)
install(TARGETS mien_library ${room_targets} EXPORT mien_targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
install(EXPORT mien_targets FILE mien_targets.cmake NAMESPACE mien:: DESTINATION ${package_folder} COMPONENT library)
foreach(room IN LISTS rooms)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/mien/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mien
    COMPONENT library FILES_MATCHING PATTERN "*.h" PATTERN detail EXCLUDE)
endforeach()

configure_file(${PROJECT_SOURCE_DIR}/cmake/mien-config.cmake.in ${PROJECT_BINARY_DIR}/package/mien-config.cmake @ONLY)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/mien-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/mien-config.cmake ${PROJECT_BINARY_DIR}/package/mien-config-version.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindCHOLMOD.cmake DESTINATION ${package_folder} COMPONENT library)
