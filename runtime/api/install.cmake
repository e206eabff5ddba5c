# Installs libraries, headers, the package for CMake and the one for pkg-config. All of it can be moved as a whole. The
# target package makes a .tar.gz of it, and a .deb.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/taut)
set(here ${PROJECT_SOURCE_DIR}/runtime/api)

if(BUILD_SHARED_LIBS)
    install(TARGETS taut EXPORT tautTargets
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
            RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    install(EXPORT tautTargets NAMESPACE taut:: DESTINATION ${package_dir})
endif()
install(TARGETS taut_static EXPORT tautStaticTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/taut DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.h" PATTERN "pages" EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TAUT_BUNDLED) # whose code is inside
    install(FILES ${TAUT_BULLET_SOURCE}/LICENSE.txt DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.bullet)
    install(FILES ${TAUT_CCD_SOURCE}/BSD-LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.libccd)
endif()

install(EXPORT tautStaticTargets NAMESPACE taut:: DESTINATION ${package_dir})
configure_package_config_file(${here}/tautConfig.cmake.in ${PROJECT_BINARY_DIR}/tautConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tautConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tautConfig.cmake ${PROJECT_BINARY_DIR}/tautConfigVersion.cmake
        DESTINATION ${package_dir})
if(NOT TAUT_BUNDLED)
    install(FILES ${here}/tautDependencies.cmake DESTINATION ${package_dir})
endif()

# Directories relative to the place of taut.pc, unless the installer gave absolute ones.
cmake_path(SET pc_dir ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${pc_dir} OUTPUT_VARIABLE prefix_from_pc)
set(TAUT_PC_PREFIX "\${pcfiledir}/${prefix_from_pc}")
foreach(kind IN ITEMS LIBDIR INCLUDEDIR)
    cmake_path(IS_ABSOLUTE CMAKE_INSTALL_${kind} absolute)
    if(absolute)
        set(TAUT_PC_${kind} ${CMAKE_INSTALL_${kind}})
        set(TAUT_PC_PREFIX ${CMAKE_INSTALL_PREFIX})
    else()
        set(TAUT_PC_${kind} "\${prefix}/${CMAKE_INSTALL_${kind}}")
    endif()
endforeach()
set(TAUT_PC_LIBS "-ltaut")
list(TRANSFORM TAUT_STATIC_NEEDS PREPEND "-l" OUTPUT_VARIABLE needs)
list(JOIN needs " " TAUT_PC_LIBS_PRIVATE)
if(NOT TAUT_BUNDLED)
    string(PREPEND TAUT_PC_LIBS_PRIVATE "-lBulletCollision -lLinearMath -lccd ")
endif()
if(NOT BUILD_SHARED_LIBS)
    string(APPEND TAUT_PC_LIBS " ${TAUT_PC_LIBS_PRIVATE}")
endif()
configure_file(${here}/taut.pc.in ${PROJECT_BINARY_DIR}/taut.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/taut.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

set(CPACK_PACKAGE_NAME taut)
set(CPACK_PACKAGE_VENDOR "Taut authors")
set(CPACK_PACKAGE_CONTACT "Taut authors")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_GENERATOR TGZ)
set(CPACK_VERBATIM_VARIABLES ON)
find_program(TAUT_DPKG dpkg)
mark_as_advanced(TAUT_DPKG)
if(TAUT_DPKG)
    list(APPEND CPACK_GENERATOR DEB)
    set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
    set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
    set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
    set(CPACK_DEBIAN_PACKAGE_DEPENDS "libstdc++6")
    if(NOT TAUT_BUNDLED) # what the static library links has the shared ones with it
        string(PREPEND CPACK_DEBIAN_PACKAGE_DEPENDS "libbullet-dev, libccd-dev, ")
    endif()
endif()
include(CPack)
