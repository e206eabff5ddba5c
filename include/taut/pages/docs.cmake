# taut_docs: the reference of the headers, with these pages, in docs/html of the build. What lacks a text fails it.
install(DIRECTORY ${CMAKE_CURRENT_LIST_DIR}/ DESTINATION ${CMAKE_INSTALL_DOCDIR} 
        FILES_MATCHING PATTERN "*.md" PATTERN "*.png")
find_program(TAUT_DOXYGEN doxygen)
mark_as_advanced(TAUT_DOXYGEN)
if(TAUT_DOXYGEN)
    add_custom_target(taut_docs
        COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/docs
        COMMAND ${CMAKE_COMMAND} -E env TAUT_ROOT=${PROJECT_SOURCE_DIR} TAUT_DOCS=${PROJECT_BINARY_DIR}/docs
                TAUT_VERSION=${PROJECT_VERSION} ${TAUT_DOXYGEN} ${CMAKE_CURRENT_LIST_DIR}/Doxyfile
        COMMENT "The reference: ${PROJECT_BINARY_DIR}/docs/html/index.html" VERBATIM)
endif()
