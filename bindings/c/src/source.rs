//! Pictures from files, folders, patterns, videos and cameras.

use std::ffi::{CString, c_char};
use std::ptr;
use std::sync::{Mutex, PoisonError};

use opendr::vision::Source;

use crate::handle::{self, Held, Out};
use crate::pointer::path;
use crate::status::{guard, guard_value, opendr_status};
use crate::value::{AnyValue, opendr_image};

/// Pictures one after the other; two threads may take from it at once.
pub struct opendr_source(());

struct Pictures(Mutex<(Source, CString)>);

impl Held for Pictures {
    const NAME: &'static str = "opendr_source";
    const MAGIC: u64 = u64::from_le_bytes(*b"ODRsourc");
}

/// Opens a picture, a folder, a pattern ("photos/\*.jpg"), a video, or a camera ("camera:0").
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_source_open(
    input: *const c_char,
    source: *mut *mut opendr_source,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, input) = unsafe { (Out::new(source, "source")?, path(input, "input")?) };
        out.set(Pictures(Mutex::new((Source::open(input)?, CString::default()))));
        Ok(())
    })
}

/// The next picture, to be freed; *image is NULL at the end. After a file that cannot be read, the next call goes on with
/// the next file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_source_next(
    source: *mut opendr_source,
    image: *mut *mut opendr_image,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, source) =
            unsafe { (Out::new(image, "image")?, handle::held::<Pictures, _>(source, "source")?) };
        let (source, path) = &mut *source.0.lock().unwrap_or_else(PoisonError::into_inner);
        let next = source.next();
        let bytes = source.last_path().map_or(&[][..], |path| path.as_os_str().as_encoded_bytes());
        *path = CString::new(bytes).unwrap_or_default();
        if let Some(frame) = next.transpose()? {
            out.set(AnyValue::from(frame.image));
        }
        Ok(())
    })
}

/// The file that the last picture, or the last failure, came from; "" for a camera, and when there was none yet. Valid
/// until the next call with this source.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_source_path(source: *const opendr_source) -> *const c_char {
    guard_value(ptr::null(), || {
        // SAFETY: the rules at the top of opendr.h.
        let source = unsafe { handle::held::<Pictures, _>(source, "source") }?;
        Ok(source.0.lock().unwrap_or_else(PoisonError::into_inner).1.as_ptr())
    })
}

/// Closes the source and makes the variable NULL; a NULL in it is closed already.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_source_free(source: *mut *mut opendr_source) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { handle::free::<Pictures, _>(source, "source") })
}
