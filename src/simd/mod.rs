//! Instruction sets. Knows nothing of rays.

/// An instruction set, as a cap on what a scene's queries may use. The kernels built so far are scalar on every CPU.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Isa {
    /// The best that the CPU has.
    #[default]
    Auto,
    /// No vector instructions beyond what the compiler's baseline has.
    Scalar,
    /// SSE4.2.
    Sse42,
    /// AVX2 and FMA.
    Avx2,
    /// AVX-512 F, VL, DQ and BW.
    Avx512,
}
