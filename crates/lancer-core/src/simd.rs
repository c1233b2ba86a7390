//! Which vector instructions the kernels are compiled for.
//!
//! Kernels are written once, over vectors of a fixed number of lanes, and compiled for every instruction set; the
//! best one that the processor has is chosen at run time. The choice never changes a picture: kernels decide
//! only what error bounds leave no doubt about, and leave the rest to one computation in `f64`.

use fearless_simd::Level;

/// A set of vector instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InstructionSet {
    /// What every processor of this architecture has: SSE2 on x86-64, NEON on ARM.
    Baseline,
    /// x86-64 with SSE4.2.
    Sse4_2,
    /// x86-64 with AVX2 and FMA.
    Avx2,
    /// x86-64 with AVX-512 as of Ice Lake or Zen 4.
    Avx512,
}

impl InstructionSet {
    /// All of them, from the least to the best.
    pub const ALL: [Self; 4] = [Self::Baseline, Self::Sse4_2, Self::Avx2, Self::Avx512];

    /// The best one that this processor has.
    pub fn best() -> Self {
        Self::ALL.into_iter().rev().find(|set| set.is_available()).unwrap_or(Self::Baseline)
    }

    /// Whether this processor has it.
    pub fn is_available(self) -> bool {
        self.level().is_some()
    }

    /// The name by which the command line's `--instructions` chooses it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Sse4_2 => "sse4.2",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The proof that the processor has it.
    #[cfg(target_arch = "x86_64")]
    pub(crate) fn level(self) -> Option<Level> {
        let best = Level::new();
        match self {
            Self::Baseline => best.as_sse2().map(Level::Sse2),
            Self::Sse4_2 => best.as_sse4_2().map(Level::Sse4_2),
            Self::Avx2 => best.as_avx2().map(Level::Avx2),
            Self::Avx512 => best.as_avx512().map(Level::Avx512),
        }
    }

    /// The proof that the processor has it.
    #[cfg(not(target_arch = "x86_64"))]
    pub(crate) fn level(self) -> Option<Level> {
        (self == Self::Baseline).then(Level::new)
    }
}
