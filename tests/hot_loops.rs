//! The machine code of the release library's kernels is in one piece, and made of vector instructions.
//!
//! What the compiler leaves out of line between a kernel's frame and the operations of `src/simd` gives the right
//! answers and takes several times as long: nothing but the machine code tells.
#![cfg(all(target_arch = "x86_64", target_os = "linux"))]

use std::collections::HashMap;
use std::path::Path;
use std::process::Command;

use iced_x86::{Decoder, DecoderOptions, FlowControl, Instruction};
use object::read::archive::ArchiveFile;
use object::{Object, ObjectSection, ObjectSymbol, RelocationTarget, Symbol};

/// An instruction set as its kernels' symbols name it, and what each kernel has of its vector instructions at the
/// least: the beginning of the name, or one of several, without the `v` of AVX, and how many.
struct Expected {
    token: &'static str,
    vector_bytes: usize,
    instructions: &'static [(&'static str, usize)],
}

/// A node test takes three of `max` and `min` and six products, fused where there is a fused form but for rays along planes;
/// a leaf test takes fifteen products more, one of them fused but in batches. Two registers make a vector where one has only four
/// floats.
const OF_TRIANGLES: [Expected; 4] = [
    Expected { token: "Scalar", vector_bytes: 16, instructions: &[("maxps", 6), ("minps", 6), ("mulps", 36)] },
    Expected { token: "Sse42", vector_bytes: 16, instructions: &[("maxps", 6), ("minps", 6), ("mulps", 36)] },
    Expected {
        token: "Avx2",
        vector_bytes: 32,
        instructions: &[("fm|mulps", 21), ("maxps", 6), ("minps", 6), ("mulps", 15), ("cmpps", 2)],
    },
    Expected {
        token: "Avx512",
        vector_bytes: 32,
        instructions: &[("fm|mulps", 21), ("maxps", 6), ("minps", 6), ("mulps", 15), ("cmpps", 2)],
    },
];

/// As [`OF_TRIANGLES`]: a leaf test of spheres takes fifteen products. Of the scalar one's minima and maxima the compiler makes
/// comparisons.
const OF_SPHERES: [Expected; 4] = [
    Expected { token: "Scalar", vector_bytes: 16, instructions: &[("mulps", 36)] },
    Expected { token: "Sse42", vector_bytes: 16, instructions: &[("maxps", 6), ("minps", 6), ("mulps", 36)] },
    Expected {
        token: "Avx2",
        vector_bytes: 32,
        instructions: &[("fm|mulps", 21), ("maxps", 3), ("minps", 3), ("mulps", 15), ("cmpps", 2)],
    },
    Expected {
        token: "Avx512",
        vector_bytes: 32,
        instructions: &[("fm|mulps", 21), ("maxps", 3), ("minps", 3), ("mulps", 15), ("cmpps", 2)],
    },
];

/// A kernel's frame, in the old and in the new mangling of symbols.
const FRAME: &str = "9vectorize5frame";
/// The same for many rays: what is called there once a run or a packet is no matter, and it may call most things.
const BATCH_FRAME: &str = "15vectorize_batch5frame";

/// What a kernel may call: other frames, what few triangles reach (out of line for that), what few hits' ids need, what rays along
/// planes need once, and what panics.
const MAY_BE_CALLED: [&str; 13] = [
    FRAME,
    ROOTS,
    "6settle",
    "3hit",
    "8precedes",
    "8hit_near",
    "19geometry_among_many",
    "7SlabRay3new",
    "4core9panicking",
    "16slice_index_fail",
    "13expect_failed",
    "13unwrap_failed",
    "_Unwind_Resume",
];

/// What kernels of spheres call, and no others: symbols do not tell them apart.
const ROOTS: &str = "12roots_slowly";

/// A frame with fewer instructions holds no traversal.
const LEAST_TRAVERSAL: usize = 400;

struct Kernel {
    symbol: String,
    instructions: Vec<Instruction>,
    /// The symbols, or the instruction where the address is computed.
    called: Vec<String>,
}

impl Kernel {
    fn count(&self, name: &str, vector_bytes: usize) -> usize {
        let is_one = |instruction: &&Instruction| {
            let mnemonic = format!("{:?}", instruction.mnemonic()).to_lowercase();
            let mut registers = (0..instruction.op_count()).map(|operand| instruction.op_register(operand));
            name.split('|').any(|name| mnemonic.trim_start_matches('v').starts_with(name))
                && registers.any(|register| register.is_vector_register() && register.size() >= vector_bytes)
        };
        self.instructions.iter().filter(is_one).count()
    }
}

/// Built as users do.
fn release_library() -> Vec<u8> {
    let target_folder = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("it is a folder of the target folder");
    let status = Command::new(env!("CARGO"))
        .args(["build", "--release", "--lib", "--locked", "--quiet", "--package", env!("CARGO_PKG_NAME")])
        .arg("--target-dir")
        .arg(target_folder)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .status()
        .expect("cargo runs");
    assert!(status.success(), "cargo build --release: {status}");
    // The archive rather than the shared library: it keeps the names of all that is called.
    std::fs::read(target_folder.join("release/libgnomon.a")).expect("cargo has written it")
}

fn kernels(archive: &[u8]) -> Vec<Kernel> {
    let members = ArchiveFile::parse(archive).expect("the library is an archive").members();
    let objects = members.filter_map(|member| {
        let bytes = member.expect("the archive is whole").data(archive).expect("the archive is whole");
        object::File::parse(bytes).ok()
    });
    objects
        .flat_map(|object| {
            let frames = object
                .symbols()
                .filter(|symbol| symbol.name().is_ok_and(|name| name.contains(FRAME) || name.contains(BATCH_FRAME)));
            frames.map(|frame| kernel(&object, &frame)).collect::<Vec<_>>()
        })
        .collect()
}

fn kernel(object: &object::File, frame: &Symbol) -> Kernel {
    let section = frame.section_index().and_then(|index| object.section_by_index(index).ok());
    let section = section.expect("a frame is compiled where it is named");
    let code = section.data_range(frame.address(), frame.size()).ok().flatten().expect("the section has the frame");
    let instructions: Vec<_> = Decoder::with_ip(64, code, frame.address(), DecoderOptions::NONE).into_iter().collect();
    let name_of = |index| {
        let symbol = object.symbol_by_index(index).ok()?;
        // A function of the same object may go by its section, which bears its name.
        let section = || object.section_by_index(symbol.section_index()?).ok()?.name().ok();
        symbol.name().ok().filter(|name| !name.is_empty()).or_else(section)
    };
    let referenced: HashMap<u64, &str> = section
        .relocations()
        .filter_map(|(address, relocation)| match relocation.target() {
            RelocationTarget::Symbol(index) => Some((address, name_of(index)?)),
            _ => None,
        })
        .collect();
    let is_call = |instruction: &&Instruction| {
        matches!(instruction.flow_control(), FlowControl::Call | FlowControl::IndirectCall)
    };
    let callee = |call: &Instruction| match (call.ip()..call.next_ip()).find_map(|byte| referenced.get(&byte)) {
        Some(&symbol) => symbol.to_owned(),
        None => format!("{:?}", call.code()),
    };
    let called = instructions.iter().filter(is_call).map(callee).collect();
    Kernel { symbol: frame.name().expect("it was found by its name").to_owned(), instructions, called }
}

#[test]
fn kernels_call_nothing_but_cold_functions() {
    let kernels = kernels(&release_library());
    for Kernel { symbol, called, .. } in kernels.iter().filter(|kernel| kernel.symbol.contains(FRAME)) {
        for callee in called {
            assert!(
                MAY_BE_CALLED.iter().any(|name| callee.contains(name)),
                "{symbol} calls {callee}: it or its caller wants #[inline(always)], or a loop in place of a closure"
            );
        }
    }
}

#[test]
fn kernels_are_made_of_whole_vectors() {
    let kernels = kernels(&release_library());
    let expected = OF_TRIANGLES.map(|expected| (false, expected)).into_iter();
    for (has_spheres, expected) in expected.chain(OF_SPHERES.map(|expected| (true, expected))) {
        let Expected { token, vector_bytes, instructions } = expected;
        let of_token: Vec<_> = kernels
            .iter()
            .filter(|kernel| kernel.symbol.contains(token) && kernel.instructions.len() >= LEAST_TRAVERSAL)
            .filter(|kernel| kernel.called.iter().any(|callee| callee.contains(ROOTS)) == has_spheres)
            .collect();
        assert!(!of_token.is_empty(), "no traversal's symbol has both {token} and {FRAME}; of spheres: {has_spheres}");
        for kernel in of_token {
            for (name, least) in instructions {
                let count = kernel.count(name, vector_bytes);
                let symbol = &kernel.symbol;
                assert!(count >= *least, "{symbol} has {count} of {name} on {vector_bytes} bytes, less than {least}");
            }
        }
    }
}
