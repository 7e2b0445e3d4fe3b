//! Which instruction set to use.

use super::Scalar;
#[cfg(target_arch = "x86_64")]
use super::{Avx2, Avx512, Sse42};

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

/// An instruction set that the CPU has, with the proof.
#[derive(Clone, Copy, Debug)]
pub(crate) enum DetectedIsa {
    Scalar(Scalar),
    #[cfg(target_arch = "x86_64")]
    Sse42(Sse42),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

impl Isa {
    /// The best that the CPU has, no better than this cap.
    pub(crate) fn resolve(self) -> DetectedIsa {
        #[cfg(target_arch = "x86_64")]
        {
            let sse42 = || Sse42::detect().map(DetectedIsa::Sse42);
            let avx2 = || Avx2::detect().map(DetectedIsa::Avx2).or_else(sse42);
            let avx512 = || Avx512::detect().map(DetectedIsa::Avx512).or_else(avx2);
            let best = match self {
                Self::Auto | Self::Avx512 => avx512(),
                Self::Avx2 => avx2(),
                Self::Sse42 => sse42(),
                Self::Scalar => None,
            };
            if let Some(best) = best {
                return best;
            }
        }
        DetectedIsa::Scalar(Scalar)
    }
}

impl From<DetectedIsa> for Isa {
    fn from(detected: DetectedIsa) -> Self {
        match detected {
            DetectedIsa::Scalar(_) => Self::Scalar,
            #[cfg(target_arch = "x86_64")]
            DetectedIsa::Sse42(_) => Self::Sse42,
            #[cfg(target_arch = "x86_64")]
            DetectedIsa::Avx2(_) => Self::Avx2,
            #[cfg(target_arch = "x86_64")]
            DetectedIsa::Avx512(_) => Self::Avx512,
        }
    }
}
