# Third-party packages, all from Debian, all required. Also used by photonavConfig.cmake, so that
# a project that links photonav finds what we found.

find_package(Eigen3 3.4 REQUIRED)
find_package(VISP 3.5 REQUIRED visp_core visp_visual_features visp_vs)
find_package(OpenCV 4 REQUIRED core calib3d features2d imgproc imgcodecs)
find_package(octomap 1.9 REQUIRED)
find_package(embree 3.13 REQUIRED)
find_package(assimp 5 REQUIRED)
find_package(ompl 1.5 REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(nlohmann_json 3 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(TBB REQUIRED)
find_package(ZLIB REQUIRED)
find_package(BZip2 REQUIRED)
find_package(Boost 1.74 REQUIRED)  # Math, headers only

# Packages that export variables instead of targets, wrapped so that they read alike.
function(_photonav_wrap name includes libraries)
    if(NOT TARGET ${name})
        add_library(${name} INTERFACE IMPORTED GLOBAL)
        target_include_directories(${name} SYSTEM INTERFACE ${includes})
        target_link_libraries(${name} INTERFACE ${libraries})
    endif()
endfunction()

# ViSP 3.5 spells its constructors vpArray2D<Type>(...), which C++20 forbids (CWG 2237) and g++
# rejects. A corrected copy of that one header, made here from the installed one, goes first in line.
set(_visp_cxx20 ${CMAKE_BINARY_DIR}/visp_cxx20)
find_file(_visp_array_header visp3/core/vpArray2D.h PATHS ${VISP_INCLUDE_DIRS} REQUIRED)
file(READ ${_visp_array_header} _visp_array)
string(REGEX REPLACE "([\n ][~ ]?)vpArray2D<Type>\\(" "\\1vpArray2D(" _visp_array "${_visp_array}")
file(CONFIGURE OUTPUT ${_visp_cxx20}/visp3/core/vpArray2D.h CONTENT "${_visp_array}" @ONLY)
_photonav_wrap(photonav_visp "${_visp_cxx20};${VISP_INCLUDE_DIRS}" "${VISP_LIBRARIES}")
_photonav_wrap(photonav_octomap "${OCTOMAP_INCLUDE_DIRS}" "${OCTOMAP_LIBRARIES}")
_photonav_wrap(photonav_ompl "${OMPL_INCLUDE_DIRS}" "${OMPL_LIBRARIES}")
_photonav_wrap(photonav_opencv "${OpenCV_INCLUDE_DIRS}" "opencv_core;opencv_calib3d;opencv_features2d;opencv_imgproc;opencv_imgcodecs")
find_library(LZ4_LIBRARY lz4 REQUIRED)
find_path(LZ4_INCLUDE_DIR lz4frame.h REQUIRED)
_photonav_wrap(photonav_lz4 "${LZ4_INCLUDE_DIR}" "${LZ4_LIBRARY}")
_photonav_wrap(photonav_embree "${EMBREE_INCLUDE_DIRS}" "embree")
