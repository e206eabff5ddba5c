# What Taut uses of Bullet and libccd, inside its libraries, from the sources in TAUT_BULLET_SOURCE and TAUT_CCD_SOURCE:
#   taut::Bullet, taut::ccd   what the library links; archives of this build
#   taut::BulletCollision     all of Bullet's BulletCollision and LinearMath, built for those that link it: tests
# In the precisions that Debian's packages have, and rounded as our own code: the same bits.
foreach(wanted IN ITEMS BULLET:src/LinearMath/btScalar.h CCD:src/ccd/ccd.h)
    string(REGEX REPLACE ":.*" "" name ${wanted})
    string(REGEX REPLACE ".*:" "" header ${wanted})
    set(source "${TAUT_${name}_SOURCE}")
    if(NOT IS_ABSOLUTE "${source}" OR NOT EXISTS "${source}/${header}")
        message(FATAL_ERROR "TAUT_${name}_SOURCE is '${source}', expected the whole path of a folder with ${header}; "
                            "Bullet and libccd come together")
    endif()
endforeach()

# taut_add_archive(NAME include-folder source...)
function(taut_add_archive name include)
    add_library(taut_${name} STATIC EXCLUDE_FROM_ALL ${ARGN})
    add_library(taut::${name} ALIAS taut_${name})
    target_include_directories(taut_${name} SYSTEM PUBLIC ${include})
    target_compile_options(taut_${name} PRIVATE -w)
    taut_compile_inside(taut_${name})
endfunction()

set(root ${TAUT_BULLET_SOURCE}/src)
taut_add_archive(Bullet ${root}
    ${root}/BulletCollision/BroadphaseCollision/btDbvt.cpp ${root}/LinearMath/btAlignedAllocator.cpp
    ${root}/LinearMath/btConvexHullComputer.cpp ${root}/LinearMath/btVector3.cpp)
file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${root}/BulletCollision/*.cpp ${root}/LinearMath/*.cpp)
taut_add_archive(BulletCollision ${root} ${sources})

file(GLOB sources CONFIGURE_DEPENDS ${TAUT_CCD_SOURCE}/src/*.c)
set(TAUT_CCD_CONFIG ${PROJECT_BINARY_DIR}/bundle)
file(CONFIGURE OUTPUT ${TAUT_CCD_CONFIG}/ccd/config.h CONTENT "#define CCD_DOUBLE\n")
taut_add_archive(ccd ${TAUT_CCD_CONFIG} ${sources})
target_include_directories(taut_ccd SYSTEM PUBLIC ${TAUT_CCD_SOURCE}/src)
target_compile_definitions(taut_ccd PUBLIC CCD_STATIC_DEFINE)

set(TAUT_LINKS taut::Bullet taut::ccd)
