use std::fmt;
use std::sync::OnceLock;

/// An instruction set that this machine supports; unsupported ones cannot be constructed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Isa(Set);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Set {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "aarch64")]
    Neon,
}

impl Isa {
    /// Returns the fastest instruction set; detected on the first call.
    pub fn best() -> Self {
        static BEST: OnceLock<Isa> = OnceLock::new();
        *BEST.get_or_init(|| Self::available().last().copied().unwrap_or(Self(Set::Portable)))
    }

    /// Returns all instruction sets of this machine, the slowest (plain Rust, no special instructions) first.
    pub fn available() -> Vec<Self> {
        let mut sets = vec![Self(Set::Portable)];
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                sets.push(Self(Set::Avx2));
            }
            if is_x86_feature_detected!("avx512f") {
                sets.push(Self(Set::Avx512));
            }
        }
        #[cfg(target_arch = "aarch64")]
        if std::arch::is_aarch64_feature_detected!("neon") {
            sets.push(Self(Set::Neon));
        }
        sets
    }

    pub(crate) fn set(self) -> Set {
        self.0
    }
}

impl fmt::Display for Isa {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            Set::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => "AVX2+FMA",
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => "AVX-512F",
            #[cfg(target_arch = "aarch64")]
            Set::Neon => "NEON",
        })
    }
}

/// Defines `unsafe fn name(isa, arguments)` from `#[inline(always)] unsafe fn body<V: Lanes>(arguments)`: the body is
/// compiled once per instruction set, and the call selects one.
macro_rules! for_every_isa {
    ($(#[$doc:meta])* $visibility:vis fn $name:ident = $body:ident($($argument:ident: $type:ty),* $(,)?) $(-> $result:ty)?) => {
        $(#[$doc])*
        ///
        /// # Safety
        /// Those of the body; `isa` guarantees that the machine supports the instructions.
        $visibility unsafe fn $name(isa: $crate::isa::Isa, $($argument: $type),*) $(-> $result)? {
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2,fma")]
            unsafe fn avx2($($argument: $type),*) $(-> $result)? {
                // SAFETY: the caller's promise; the instructions are enabled here.
                unsafe { $body::<$crate::lanes::Avx2>($($argument),*) }
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f")]
            unsafe fn avx512($($argument: $type),*) $(-> $result)? {
                // SAFETY: the caller's promise; the instructions are enabled here.
                unsafe { $body::<$crate::lanes::Avx512>($($argument),*) }
            }
            #[cfg(target_arch = "aarch64")]
            #[target_feature(enable = "neon")]
            unsafe fn neon($($argument: $type),*) $(-> $result)? {
                // SAFETY: the caller's promise; the instructions are enabled here.
                unsafe { $body::<$crate::lanes::Neon>($($argument),*) }
            }
            // SAFETY: the caller's promise, and an `Isa` is only made where the machine has it.
            unsafe {
                match isa.set() {
                    $crate::isa::Set::Portable => $body::<$crate::lanes::Portable>($($argument),*),
                    #[cfg(target_arch = "x86_64")]
                    $crate::isa::Set::Avx2 => avx2($($argument),*),
                    #[cfg(target_arch = "x86_64")]
                    $crate::isa::Set::Avx512 => avx512($($argument),*),
                    #[cfg(target_arch = "aarch64")]
                    $crate::isa::Set::Neon => neon($($argument),*),
                }
            }
        }
    };
}
pub(crate) use for_every_isa;
