# `cmake --install` and find_package(photonav): targets photonav::core,
# photonav::planning, photonav::tracking and photonav::mission.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/photonav)
set_target_properties(photonav_core PROPERTIES EXPORT_NAME core)
set_target_properties(photonav_planning PROPERTIES EXPORT_NAME planning)
set_target_properties(photonav_tracking PROPERTIES EXPORT_NAME tracking)
set_target_properties(photonav_mission PROPERTIES EXPORT_NAME mission)
install(TARGETS photonav_core photonav_planning photonav_tracking photonav_mission EXPORT photonav_targets)
install(TARGETS photonav)
# Public headers. In the source tree they include each other by folder ("geometry/camera.hpp"); installed
# they say <photonav/...>, so that a program may have folders of the same names.
foreach(root src planning tracking mission)
    file(GLOB_RECURSE _headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/${root} ${root}/*.hpp)
    list(FILTER _headers EXCLUDE REGEX
        "/(yaml_reader|key_table|config_keys|recording_config|map_config|replay_config|simd|product_sums|keyframe_points|voxel_rays|opencv_image|surface_intersection)\\.hpp$")
    foreach(header IN LISTS _headers)
        list(APPEND _public_headers ${root}/${header})
    endforeach()
endforeach()
install(CODE "set(PHOTONAV_HEADERS \"${_public_headers}\")
set(PHOTONAV_SOURCE_DIR \"${PROJECT_SOURCE_DIR}\")
include(\"${PROJECT_SOURCE_DIR}/cmake/install_headers.cmake\")")
# Completion of command lines, printed by the executable itself.
set(_completions ${PROJECT_BINARY_DIR}/completions)
file(MAKE_DIRECTORY ${_completions})
add_custom_command(TARGET photonav POST_BUILD
    COMMAND photonav completion bash > ${_completions}/photonav
    COMMAND photonav completion zsh > ${_completions}/_photonav VERBATIM)
install(FILES ${_completions}/photonav DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${_completions}/_photonav DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(DIRECTORY config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/photonav/config)
install(EXPORT photonav_targets NAMESPACE photonav:: DESTINATION ${_config_dir})
configure_package_config_file(cmake/photonavConfig.cmake.in
    ${PROJECT_BINARY_DIR}/photonavConfig.cmake INSTALL_DESTINATION ${_config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/photonavConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/photonavConfig.cmake
    ${PROJECT_BINARY_DIR}/photonavConfigVersion.cmake cmake/dependencies.cmake
    DESTINATION ${_config_dir})
