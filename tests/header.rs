//! `include/gnomon.h` and `include/gnomon.symbols` are what the code says, to the byte.

use std::path::Path;

/// Compares, or writes when `UPDATE_HEADER` is set.
fn assert_committed(name: &str, expected: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("include").join(name);
    if std::env::var_os("UPDATE_HEADER").is_some() {
        std::fs::write(&path, expected).expect("the file is writable");
        return;
    }
    let committed = std::fs::read_to_string(&path).expect("the file is readable");
    let differs = committed.lines().zip(expected.lines()).position(|(a, b)| a != b);
    assert!(
        committed == expected,
        "include/{name} is not what the code says, first at line {:?}: run UPDATE_HEADER=1 cargo test --test header",
        differs.map(|line| line + 1)
    );
}

/// The files of the interface in the order in which a reader wants them.
const SOURCES: [&str; 12] = [
    "types.rs",
    "status.rs",
    "options.rs",
    "builder.rs",
    "scene.rs",
    "query.rs",
    "surface_point.rs",
    "photometry.rs",
    "solid_angle.rs",
    "sampling.rs",
    "irradiance.rs",
    "version.rs",
];

fn generated_header() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml is valid");
    let builder = SOURCES.iter().fold(cbindgen::Builder::new().with_config(config), |builder, source| {
        builder.with_src(root.join("src/ffi").join(source))
    });
    let bindings = builder.generate().expect("cbindgen understands src/ffi");
    let mut header = Vec::new();
    bindings.write(&mut header);
    let header = String::from_utf8(header).expect("the header is UTF-8");
    let lines = without_safety_sections(&header).lines().map(unsigned_constant).collect::<Vec<_>>().join("\n");
    lines.replace("\n\n\n", "\n\n").replace("\n\n\n", "\n\n") + "\n"
}

/// All whole constants are `uint32_t`: `#define NAME 1` gets a `u`.
fn unsigned_constant(line: &str) -> String {
    let is_number = line.starts_with("#define ") && line.ends_with(|c: char| c.is_ascii_digit()) && !line.contains('.');
    if is_number { format!("{line}u") } else { line.to_owned() }
}

/// Rust's "# Safety" sections say in Rust's terms what the manual says in C's: they are left out.
fn without_safety_sections(header: &str) -> String {
    let mut kept: Vec<&str> = Vec::new();
    let mut in_section = false;
    for line in header.lines() {
        let starts_section = line.trim() == "// # Safety";
        in_section = starts_section || (in_section && line.trim_start().starts_with("//"));
        if starts_section && kept.last().is_some_and(|last| last.trim() == "//") {
            kept.pop();
        }
        if !in_section {
            kept.push(line);
        }
    }
    kept.join("\n") + "\n"
}

#[test]
fn header_matches_the_code() {
    assert_committed("gnomon.h", &generated_header());
}

#[test]
fn symbol_list_matches_the_header() {
    let header = generated_header();
    let mut symbols: Vec<&str> = header
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')))
        .filter(|word| word.starts_with("gnomon_"))
        .collect();
    symbols.sort_unstable();
    symbols.dedup();
    assert_committed("gnomon.symbols", &(symbols.join("\n") + "\n"));
}
