//! Which instruction set to use.

/// An instruction set: as a cap on what a scene's queries may use, or as what they do use.
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

impl Isa {
    /// The best that is built and that the CPU has, no better than this cap. There are no kernels for AVX-512 yet.
    pub(crate) fn resolve(self) -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if matches!(self, Self::Auto | Self::Avx512 | Self::Avx2) && super::Avx2::detect().is_some() {
                return Self::Avx2;
            }
            if self != Self::Scalar && super::Sse42::detect().is_some() {
                return Self::Sse42;
            }
        }
        Self::Scalar
    }
}
