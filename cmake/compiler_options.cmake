# Warnings, vector instruction set and precompiled headers of our own targets.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(_photonav_march x86-64-v3)
endif()
set(PHOTONAV_MARCH "${_photonav_march}" CACHE STRING
    "instruction set given to -march: x86-64-v3 (AVX2), native, or empty for the compiler's default")

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_DEPEND=1
        CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${CCACHE})
endif()

# Never -ffast-math: it breaks Eigen's fixed-size inverses without a word.
# The instruction set is PUBLIC because the alignment of Eigen's types depends on it. All targets share
# the precompiled header of photonav_core, for which their macros and code model must be the same:
# hence fmt and -fPIC (instead of -fPIE) for programs too. Left out of the sanitizers are
# nonnull-attribute (ViSP's headers copy empty images by memcpy from null) and what costs a third of
# the build to find no more than the address sanitizer and the processor do: null, alignment,
# object-size, pointer-overflow, vptr.
if(PHOTONAV_SANITIZE STREQUAL "address")
    set(_sanitizers -fsanitize=address,undefined)
    set(_sanitizer_options
        -fno-sanitize=nonnull-attribute,null,alignment,object-size,pointer-overflow,vptr
        -fno-sanitize-recover=undefined)
elseif(PHOTONAV_SANITIZE STREQUAL "thread")
    set(_sanitizers -fsanitize=thread)
elseif(PHOTONAV_SANITIZE)
    message(FATAL_ERROR "PHOTONAV_SANITIZE is ${PHOTONAV_SANITIZE}; it may be OFF, address or thread")
endif()
if(PHOTONAV_SANITIZE)
    list(APPEND _sanitizer_options -fno-omit-frame-pointer -UNDEBUG -O1)
endif()

function(photonav_compiler_options target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    # Eigen's functions, which allocate with the alignment of this instruction set, must not take the place
    # of those in Debian's libraries, which free without: no symbol is exported.
    target_compile_options(${target} PUBLIC -fvisibility=hidden -fvisibility-inlines-hidden)
    if(PHOTONAV_MARCH)
        target_compile_options(${target} PUBLIC -march=${PHOTONAV_MARCH})
    endif()
    target_compile_options(${target} PRIVATE
        -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wno-psabi -Wno-overlength-strings
        -fno-math-errno -fno-trapping-math -fpch-preprocess
        $<$<BOOL:${PHOTONAV_WERROR}>:-Werror>
        ${_sanitizers} ${_sanitizer_options})
    target_link_options(${target} PUBLIC ${_sanitizers})
    if(target STREQUAL photonav_core)
        target_precompile_headers(${target} PRIVATE
            <Eigen/Dense> <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <memory>
            <optional> <random> <span> <stdexcept> <string> <unordered_map> <vector>)
    else()
        target_precompile_headers(${target} REUSE_FROM photonav_core)
        set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
        target_compile_options(${target} PRIVATE -fPIC)
    endif()
endfunction()
