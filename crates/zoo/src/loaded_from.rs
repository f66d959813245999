//! Path of the program or shared library that contains this code.

use std::path::PathBuf;

/// Returns the path of the program or shared library that contains this function, if it is known.
#[cfg(unix)]
pub(crate) fn loaded_from() -> Option<PathBuf> {
    use std::ffi::{CStr, OsStr};
    use std::mem::MaybeUninit;
    use std::os::unix::ffi::OsStrExt;

    let mut found = MaybeUninit::<libc::Dl_info>::uninit();
    let here = loaded_from as fn() -> Option<PathBuf> as *const libc::c_void;
    // SAFETY: `found` is large enough to be written to, and any address may be asked for.
    let name = unsafe {
        if libc::dladdr(here, found.as_mut_ptr()) == 0 {
            return None;
        }
        found.assume_init().dli_fname
    };
    if name.is_null() {
        return None;
    }
    // SAFETY: the loader keeps the name, which ends with a zero, as long as the library is loaded, and this function is part of it.
    let name = unsafe { CStr::from_ptr(name) };
    std::fs::canonicalize(OsStr::from_bytes(name.to_bytes())).ok()
}

/// Returns `None` on Windows and other systems, where the caller uses the program's path.
#[cfg(not(unix))]
pub(crate) fn loaded_from() -> Option<PathBuf> {
    None
}
