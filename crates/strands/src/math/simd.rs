//! Picks the widest vector instructions that the machine has, at run time.

/// The vector instructions that the kernels run with, narrow before wide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SimdLevel {
    /// What the target always has: SSE2 on x86-64, NEON on AArch64, simd128 or none in WebAssembly.
    Baseline,
    /// AVX2, four numbers wide.
    Avx2,
    /// AVX-512, eight numbers wide.
    Avx512,
}

impl SimdLevel {
    /// The widest that this machine has.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl")
            {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    /// How many numbers of 64 bits one instruction takes.
    pub const fn width(self) -> usize {
        match self {
            Self::Baseline => {
                if cfg!(all(target_arch = "wasm32", not(target_feature = "simd128"))) {
                    1
                } else {
                    2
                }
            }
            Self::Avx2 => 4,
            Self::Avx512 => 8,
        }
    }

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "AVX-512",
            Self::Avx2 => "AVX2",
            Self::Baseline => {
                if cfg!(target_arch = "x86_64") {
                    "SSE2"
                } else if cfg!(target_feature = "simd128") {
                    "simd128"
                } else if cfg!(target_arch = "aarch64") {
                    "NEON"
                } else {
                    "scalar"
                }
            }
        }
    }
}

/// Work that is compiled once for each [`SimdLevel`]. `run` must be `#[inline(always)]`, so that its arithmetic takes the
/// instructions of the function that it is put into. None of the levels turns on fused multiply-add, so all give the same bits.
pub(crate) trait Kernel {
    /// What the work gives.
    type Output;
    /// Does the work.
    fn run(self) -> Self::Output;
}

/// Runs a kernel with the given instructions, or with the widest below them that the machine has.
#[inline]
pub(crate) fn dispatch<K: Kernel>(level: SimdLevel, kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    {
        // Detection is a load from a cache.
        let level = if level.width() > SimdLevel::detect().width() { SimdLevel::detect() } else { level };
        // SAFETY: the level is one that `detect` found on this machine. Calling a function with a target feature from one without is
        // the only way to choose instructions at run time; `every_simd_level_gives_the_same_bits` runs all of them.
        #[allow(unsafe_code)]
        match level {
            SimdLevel::Avx512 => return unsafe { avx512(kernel) },
            SimdLevel::Avx2 => return unsafe { avx2(kernel) },
            SimdLevel::Baseline => {}
        }
    }
    let _ = level;
    kernel.run()
}

/// Runs a kernel with AVX2, whatever wider instructions the machine has; `None` where it has not got that.
#[cfg(target_arch = "x86_64")]
#[inline]
pub(crate) fn with_avx2<K: Kernel>(kernel: K) -> Option<K::Output> {
    if SimdLevel::detect().width() < SimdLevel::Avx2.width() {
        return None;
    }
    // SAFETY: as above.
    #[allow(unsafe_code)]
    Some(unsafe { avx2(kernel) })
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
pub(super) fn avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,avx512f,avx512dq,avx512vl")]
pub(super) fn avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}
