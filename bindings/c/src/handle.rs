//! Handles of C: pointers to boxed values, identified by their first bytes.

use std::ptr;

use opendr::{Error, Result};

use crate::pointer::{null, place};

/// Types that handles can contain.
pub(crate) trait Held {
    /// Name of the type in C.
    const NAME: &'static str;
    /// First bytes of its handles.
    const MAGIC: u64;
}

/// The memory that a handle points to.
#[repr(C)]
struct Handle<T> {
    magic: u64,
    held: T,
}

/// Creates a handle.
pub(crate) fn handle<T: Held, P>(held: T) -> *mut P {
    Box::into_raw(Box::new(Handle { magic: T::MAGIC, held })).cast()
}

/// Returns the value of a handle.
///
/// # Safety
/// The pointer is null or points to at least eight bytes; a handle of this kind is not freed or changed meanwhile.
pub(crate) unsafe fn held<'a, T: Held, P>(pointer: *const P, name: &str) -> Result<&'a T> {
    let handle = pointer.cast::<Handle<T>>();
    // SAFETY: the caller's promise.
    unsafe { check(handle, name) }?;
    // SAFETY: a handle of this kind; the rest is the caller's promise.
    Ok(unsafe { &(*handle).held })
}

/// Returns the value of a handle, to change it.
///
/// # Safety
/// The same as for [`held`], and the handle is not used elsewhere meanwhile.
pub(crate) unsafe fn held_mut<'a, T: Held, P>(pointer: *mut P, name: &str) -> Result<&'a mut T> {
    let handle = pointer.cast::<Handle<T>>();
    // SAFETY: the caller's promise.
    unsafe { check(handle, name) }?;
    // SAFETY: a handle of this kind; the rest is the caller's promise.
    Ok(unsafe { &mut (*handle).held })
}

/// Frees the handle in a variable and sets the variable to null; does nothing if it is null.
///
/// # Safety
/// `variable` is null or points to a variable, which contains null or a valid argument of [`held_mut`].
pub(crate) unsafe fn free<T: Held, P>(variable: *mut *mut P, name: &str) -> Result<()> {
    let variable = place(variable, name)?;
    // SAFETY: the caller's promise.
    let handle = unsafe { *variable }.cast::<Handle<T>>();
    if handle.is_null() {
        return Ok(());
    }
    // SAFETY: the caller's promise.
    unsafe { check(handle, name) }?;
    // SAFETY: a handle of this kind, created by `handle`; its first bytes are cleared, so that a second free through another
    // variable is detected as long as the memory is not reused.
    unsafe {
        variable.write(ptr::null_mut());
        ptr::write_volatile(&raw mut (*handle).magic, 0);
        drop(Box::from_raw(handle));
    }
    Ok(())
}

/// # Safety
/// The same as for [`held`].
unsafe fn check<T: Held>(handle: *const Handle<T>, name: &str) -> Result<()> {
    if handle.is_null() {
        return Err(null(name));
    }
    // SAFETY: aligned, and at least eight bytes by the caller's promise.
    if !handle.is_aligned() || unsafe { (*handle).magic } != T::MAGIC {
        return Err(Error::invalid_input(format!(
            "{name} is not an {} (another type, or freed); give a handle that an OpenDR function created",
            T::NAME
        )));
    }
    Ok(())
}

/// A variable for a new handle, null until the call succeeds.
pub(crate) struct Out<P>(*mut *mut P);

impl<P> Out<P> {
    /// Sets the variable to null.
    ///
    /// # Safety
    /// `variable` is null or may be written to.
    pub(crate) unsafe fn new(variable: *mut *mut P, name: &str) -> Result<Self> {
        let variable = place(variable, name)?;
        // SAFETY: not null and aligned; the rest is the caller's promise.
        unsafe { variable.write(ptr::null_mut()) };
        Ok(Self(variable))
    }

    /// Sets the variable to a new handle.
    pub(crate) fn set<T: Held>(self, held: T) {
        // SAFETY: as `new` was promised.
        unsafe { self.0.write(handle(held)) };
    }
}
