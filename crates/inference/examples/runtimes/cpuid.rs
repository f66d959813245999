//! Hides AVX-512 from this process, so that both sides of a comparison select their kernels for AVX2.

use opendr_engine::{Error, Result};

/// Makes CPUID report neither AVX-512 nor AMX nor AVX-VNNI to this thread and those that it starts.
///
/// # Errors
/// `Unsupported` where the processor cannot trap CPUID.
#[cfg(all(target_arch = "x86_64", target_os = "linux"))]
pub fn mask_avx512() -> Result<()> {
    // SAFETY: the action is zero but for its handler and flags, and outlives the call.
    let installed = unsafe {
        let mut action: libc::sigaction = std::mem::zeroed();
        action.sa_sigaction = trap::on_fault as extern "C" fn(_, _, _) as usize;
        action.sa_flags = libc::SA_SIGINFO;
        libc::sigaction(libc::SIGSEGV, &action, std::ptr::null_mut()) == 0
    };
    if installed && trap::set_cpuid(false) {
        return Ok(());
    }
    Err(Error::unsupported(
        "this processor or kernel cannot trap CPUID (cpuid_fault), so that AVX-512 cannot be hidden",
    ))
}

/// Returns the error of targets without it.
#[cfg(not(all(target_arch = "x86_64", target_os = "linux")))]
pub fn mask_avx512() -> Result<()> {
    Err(Error::unsupported("AVX-512 is hidden on Linux on x86-64 only"))
}

#[cfg(all(target_arch = "x86_64", target_os = "linux"))]
mod trap {
    use std::arch::x86_64::{__cpuid_count, CpuidResult};
    use std::ffi::c_int;

    const ARCH_SET_CPUID: c_int = 0x1012;
    /// Bits of leaf 7 by subleaf, in EAX, EBX, ECX and EDX: AVX-512, AVX-VNNI, AVX-IFMA and AMX.
    const HIDDEN: [[u32; 4]; 2] = [
        [
            0,
            1 << 16 | 1 << 17 | 1 << 21 | 0b11 << 26 | 1 << 28 | 0b11 << 30,
            1 << 1 | 1 << 6 | 1 << 11 | 1 << 12 | 1 << 14,
            0b11 << 2 | 1 << 8 | 0b1111 << 22,
        ],
        [1 << 4 | 1 << 5 | 1 << 21 | 1 << 23, 0, 0, 1 << 4 | 1 << 5 | 1 << 8 | 1 << 10 | 1 << 19],
    ];

    /// Sets whether the instruction is executed by this thread, or is a fault.
    pub fn set_cpuid(enabled: bool) -> bool {
        // SAFETY: the call has no pointers.
        unsafe { libc::syscall(libc::SYS_arch_prctl, ARCH_SET_CPUID, libc::c_long::from(enabled)) == 0 }
    }

    /// Executes the CPUID that faulted, and removes the hidden bits from its result.
    pub extern "C" fn on_fault(_: c_int, _: *mut libc::siginfo_t, context: *mut libc::ucontext_t) {
        // SAFETY: the kernel gives a context to the handler of SA_SIGINFO; the instruction pointer is that of an instruction that
        // this thread was about to execute.
        unsafe {
            let registers = &mut (*context).uc_mcontext.gregs;
            let instruction = registers[libc::REG_RIP as usize] as *const [u8; 2];
            if instruction.read_unaligned() != [0x0f, 0xa2] {
                // Another fault: the default action follows on return.
                libc::signal(libc::SIGSEGV, libc::SIG_DFL);
                return;
            }
            let (leaf, subleaf) =
                (registers[libc::REG_RAX as usize] as u32, registers[libc::REG_RCX as usize] as u32);
            set_cpuid(true);
            let CpuidResult { eax, ebx, ecx, edx } = __cpuid_count(leaf, subleaf);
            set_cpuid(false);
            let hidden = match leaf {
                7 => HIDDEN.get(subleaf as usize).copied().unwrap_or([0; 4]),
                _ => [0; 4],
            };
            let places = [libc::REG_RAX, libc::REG_RBX, libc::REG_RCX, libc::REG_RDX];
            for ((place, value), hidden) in places.into_iter().zip([eax, ebx, ecx, edx]).zip(hidden) {
                registers[place as usize] = i64::from(value & !hidden);
            }
            registers[libc::REG_RIP as usize] += 2;
        }
    }
}
