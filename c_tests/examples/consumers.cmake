# Every way a user may get gnomon, each built and run in a folder of its own: find_package, pkg-config, add_subdirectory, FetchContent.

set(consumer_dir "${CMAKE_CURRENT_BINARY_DIR}/consumers")
set(consumer_prefix "${consumer_dir}/prefix")
set(examples_dir "${CMAKE_CURRENT_LIST_DIR}")

# A prefix that differs from CMAKE_INSTALL_PREFIX: the package files have to be relocatable.
add_test(NAME consumer_install COMMAND ${CMAKE_COMMAND} --install "${PROJECT_BINARY_DIR}" --prefix "${consumer_prefix}")
set_tests_properties(consumer_install PROPERTIES FIXTURES_SETUP installed LABELS api TIMEOUT 60)

# gnomon_consumer(name option...): configures the examples with the options, builds them, and runs their own tests.
function(gnomon_consumer name)
    add_test(NAME consumer_${name} COMMAND ${CMAKE_CTEST_COMMAND}
        --build-and-test "${examples_dir}" "${consumer_dir}/${name}" --build-generator "${CMAKE_GENERATOR}"
        --build-options -DCMAKE_C_COMPILER=${CMAKE_C_COMPILER} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} ${ARGN}
        --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure)
    set_tests_properties(consumer_${name} PROPERTIES LABELS api TIMEOUT 300)
endfunction()

gnomon_consumer(package_shared -DCMAKE_PREFIX_PATH=${consumer_prefix})
gnomon_consumer(package_static -DCMAKE_PREFIX_PATH=${consumer_prefix} -DGNOMON_LIBRARY=gnomon::gnomon_static)
set_tests_properties(consumer_package_shared consumer_package_static PROPERTIES FIXTURES_REQUIRED installed)

# Cargo's folder is shared, so that these two compile no Rust again.
set(source_options -DGNOMON_SOURCE=${PROJECT_SOURCE_DIR} -DGNOMON_CARGO_TARGET_DIR=${GNOMON_CARGO_TARGET_DIR}
                   -DCARGO_EXECUTABLE=${CARGO_EXECUTABLE})
gnomon_consumer(subdirectory -DGNOMON_FROM=subdirectory ${source_options})
gnomon_consumer(fetchcontent -DGNOMON_FROM=fetchcontent ${source_options} -DGNOMON_LIBRARY=gnomon::gnomon_static)

foreach(linkage shared static)
    add_test(NAME consumer_pkg_config_${linkage}
             COMMAND sh "${examples_dir}/pkg_config.sh" ${linkage} "${consumer_prefix}/${CMAKE_INSTALL_LIBDIR}"
                     "${consumer_dir}/pkg_config_${linkage}")
    set_tests_properties(consumer_pkg_config_${linkage} PROPERTIES FIXTURES_REQUIRED installed LABELS api TIMEOUT 60
        ENVIRONMENT "CC=${CMAKE_C_COMPILER};PKG_CONFIG=${PKG_CONFIG_EXECUTABLE}"
        PASS_REGULAR_EXPRESSION "^hit triangle 0 at t = 2\n$")
endforeach()
