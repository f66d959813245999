//! What C holds: boxes behind pointers, known by their first bytes.

use std::ptr;

use opendr::{Error, Result};

use crate::pointer::{null, place};

/// What can stand behind a handle.
pub(crate) trait Held {
    /// What C calls it.
    const NAME: &'static str;
    /// The first bytes of its handles.
    const MAGIC: u64;
}

/// What a handle's pointer leads to.
#[repr(C)]
struct Handle<T> {
    magic: u64,
    held: T,
}

/// A new handle.
pub(crate) fn handle<T: Held, P>(held: T) -> *mut P {
    Box::into_raw(Box::new(Handle { magic: T::MAGIC, held })).cast()
}

/// What a handle holds.
///
/// # Safety
/// The pointer is null or leads to at least eight bytes; a handle of this kind is not freed or changed meanwhile.
pub(crate) unsafe fn held<'a, T: Held, P>(pointer: *const P, name: &str) -> Result<&'a T> {
    let handle = pointer.cast::<Handle<T>>();
    // SAFETY: the caller's promise.
    unsafe { check(handle, name) }?;
    // SAFETY: a handle of this kind; the rest is the caller's promise.
    Ok(unsafe { &(*handle).held })
}

/// What a handle holds, to change it.
///
/// # Safety
/// As [`held`], and nobody else uses the handle meanwhile.
pub(crate) unsafe fn held_mut<'a, T: Held, P>(pointer: *mut P, name: &str) -> Result<&'a mut T> {
    let handle = pointer.cast::<Handle<T>>();
    // SAFETY: the caller's promise.
    unsafe { check(handle, name) }?;
    // SAFETY: a handle of this kind; the rest is the caller's promise.
    Ok(unsafe { &mut (*handle).held })
}

/// Frees what a variable holds and makes it null; a null in it is freed already.
///
/// # Safety
/// `variable` is null or leads to a variable, which holds null or what [`held_mut`] may take.
pub(crate) unsafe fn free<T: Held, P>(variable: *mut *mut P, name: &str) -> Result<()> {
    let variable = place(variable, name)?;
    // SAFETY: the caller's promise.
    let handle = unsafe { *variable }.cast::<Handle<T>>();
    if handle.is_null() {
        return Ok(());
    }
    // SAFETY: the caller's promise.
    unsafe { check(handle, name) }?;
    // SAFETY: a handle of this kind, made by `handle`; its first bytes are wiped, so that a second free through another
    // variable is found as long as the memory is not used again.
    unsafe {
        variable.write(ptr::null_mut());
        ptr::write_volatile(&raw mut (*handle).magic, 0);
        drop(Box::from_raw(handle));
    }
    Ok(())
}

/// # Safety
/// As [`held`].
unsafe fn check<T: Held>(handle: *const Handle<T>, name: &str) -> Result<()> {
    if handle.is_null() {
        return Err(null(name));
    }
    // SAFETY: aligned, and at least eight bytes by the caller's promise.
    if !handle.is_aligned() || unsafe { (*handle).magic } != T::MAGIC {
        return Err(Error::invalid_input(format!(
            "{name} is no {} (another type, or freed); give what an OpenDR function made",
            T::NAME
        )));
    }
    Ok(())
}

/// A variable for a new handle: null until the call succeeds.
pub(crate) struct Out<P>(*mut *mut P);

impl<P> Out<P> {
    /// Makes the variable null.
    ///
    /// # Safety
    /// `variable` is null or may be written to.
    pub(crate) unsafe fn new(variable: *mut *mut P, name: &str) -> Result<Self> {
        let variable = place(variable, name)?;
        // SAFETY: not null and aligned; the rest is the caller's promise.
        unsafe { variable.write(ptr::null_mut()) };
        Ok(Self(variable))
    }

    /// Gives the variable a new handle.
    pub(crate) fn set<T: Held>(self, held: T) {
        // SAFETY: as `new` was promised.
        unsafe { self.0.write(handle(held)) };
    }
}
