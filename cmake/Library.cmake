# The targets gnomon::gnomon and gnomon::gnomon_static, from the build tree.

set(GNOMON_SHARED_FILE libgnomon.so.${PROJECT_VERSION})
set(GNOMON_SONAME libgnomon.so.${PROJECT_VERSION_MAJOR})  # build.rs gives the library the same

# What the Rust standard library needs from a C program that links the archive: `rustc --print native-static-libs`.
set(GNOMON_STATIC_DEPENDENCIES gcc_s util rt pthread m dl c)

gnomon_cargo_build(gnomon_cargo PACKAGE gnomon
                   OUTPUTS libgnomon.so=${GNOMON_SHARED_FILE} libgnomon.a)
add_custom_command(TARGET gnomon_cargo POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E create_symlink ${GNOMON_SHARED_FILE} ${GNOMON_SONAME}
    COMMAND ${CMAKE_COMMAND} -E create_symlink ${GNOMON_SONAME} libgnomon.so
    WORKING_DIRECTORY "${PROJECT_BINARY_DIR}/lib" VERBATIM)

add_library(gnomon::gnomon SHARED IMPORTED GLOBAL)
set_target_properties(gnomon::gnomon PROPERTIES
    IMPORTED_LOCATION "${PROJECT_BINARY_DIR}/lib/${GNOMON_SHARED_FILE}"
    IMPORTED_SONAME ${GNOMON_SONAME})

add_library(gnomon::gnomon_static STATIC IMPORTED GLOBAL)
set_target_properties(gnomon::gnomon_static PROPERTIES
    IMPORTED_LOCATION "${PROJECT_BINARY_DIR}/lib/libgnomon.a"
    INTERFACE_LINK_LIBRARIES "${GNOMON_STATIC_DEPENDENCIES}")

foreach(library gnomon::gnomon gnomon::gnomon_static)
    target_include_directories(${library} INTERFACE "${PROJECT_SOURCE_DIR}/include")
    add_dependencies(${library} gnomon_cargo)
endforeach()
