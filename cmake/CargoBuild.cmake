# Finds cargo, and gives gnomon_cargo_build(): one package of the workspace, built by `cargo build --release --locked`.

set(cargo_hints "$ENV{CARGO_HOME}/bin" "$ENV{HOME}/.cargo/bin")
find_program(CARGO_EXECUTABLE cargo HINTS ${cargo_hints})
find_program(RUSTC_EXECUTABLE rustc HINTS ${cargo_hints})
if(NOT CARGO_EXECUTABLE OR NOT RUSTC_EXECUTABLE)
    message(FATAL_ERROR "gnomon needs cargo and rustc: install Rust from https://rustup.rs, or set CARGO_EXECUTABLE and RUSTC_EXECUTABLE")
endif()

file(STRINGS "${PROJECT_SOURCE_DIR}/Cargo.toml" manifest_rust_version REGEX "^rust-version *=" LIMIT_COUNT 1)
string(REGEX MATCH "[0-9.]+" required_rust_version "${manifest_rust_version}")
execute_process(COMMAND "${RUSTC_EXECUTABLE}" --version OUTPUT_VARIABLE GNOMON_RUSTC_VERSION
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+" rustc_version "${GNOMON_RUSTC_VERSION}")
if(rustc_version VERSION_LESS required_rust_version)
    message(FATAL_ERROR "gnomon needs Rust ${required_rust_version} or newer, ${RUSTC_EXECUTABLE} is ${rustc_version}: run `rustup update`")
endif()

# At the top level cargo's own folder serves, so that nothing is compiled twice; inside another project the source tree stays untouched.
if(PROJECT_IS_TOP_LEVEL)
    set(default_cargo_dir "${PROJECT_SOURCE_DIR}/target")
else()
    set(default_cargo_dir "${PROJECT_BINARY_DIR}/cargo")
endif()
set(GNOMON_CARGO_TARGET_DIR "${default_cargo_dir}" CACHE PATH "Where cargo puts its build products")

# gnomon_cargo_build(TARGET PACKAGE name OUTPUTS file...)
# Cargo itself decides what is out of date, so it runs at every build; unchanged outputs keep their time stamp in `lib/`.
# OUTPUTS are copied from cargo's release folder to ${PROJECT_BINARY_DIR}/lib; `from=to` renames on the way.
function(gnomon_cargo_build target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "PACKAGE" "OUTPUTS")
    set(copies)
    set(products)
    foreach(output IN LISTS arg_OUTPUTS)
        string(REGEX REPLACE "=.*" "" from "${output}")
        string(REGEX REPLACE ".*=" "" to "${output}")
        list(APPEND copies COMMAND ${CMAKE_COMMAND} -E copy_if_different
                           "${GNOMON_CARGO_TARGET_DIR}/release/${from}" "${PROJECT_BINARY_DIR}/lib/${to}")
        list(APPEND products "${PROJECT_BINARY_DIR}/lib/${to}")
    endforeach()
    add_custom_target(${target} ALL
        COMMAND "${CARGO_EXECUTABLE}" build --release --locked --lib --package ${arg_PACKAGE}
                --target-dir "${GNOMON_CARGO_TARGET_DIR}"
        COMMAND ${CMAKE_COMMAND} -E make_directory "${PROJECT_BINARY_DIR}/lib"
        ${copies}
        BYPRODUCTS ${products}
        WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
        COMMENT "cargo build --release: ${arg_PACKAGE}"
        USES_TERMINAL VERBATIM)
endfunction()
