# What the static library links, found the same way by Taut's build and by find_package(taut):
#   taut::ccd                                 libccd, by its own package
#   taut::BulletCollision, taut::LinearMath   two of Bullet's libraries, in single precision
#   TAUT_DEPENDENCIES_MISSING                 names of what was not found
# Debian's Bullet package for CMake is broken and names libraries that Taut must not use: look for the files.
set(TAUT_DEPENDENCIES_MISSING "")

find_package(ccd QUIET)
if(NOT TARGET ccd)
    list(APPEND TAUT_DEPENDENCIES_MISSING libccd)
elseif(NOT TARGET taut::ccd)
    add_library(taut::ccd ALIAS ccd)
endif()

foreach(name IN ITEMS LinearMath BulletCollision)
    find_library(TAUT_${name}_LIBRARY ${name})
    mark_as_advanced(TAUT_${name}_LIBRARY)
    if(NOT TAUT_${name}_LIBRARY)
        list(APPEND TAUT_DEPENDENCIES_MISSING lib${name})
    elseif(NOT TARGET taut::${name})
        add_library(taut::${name} UNKNOWN IMPORTED GLOBAL)
        set_target_properties(taut::${name} PROPERTIES IMPORTED_LOCATION "${TAUT_${name}_LIBRARY}")
    endif()
endforeach()
list(JOIN TAUT_DEPENDENCIES_MISSING ", " TAUT_DEPENDENCIES_MISSING)
