//! Images from files, folders, patterns, videos and cameras.

use std::ffi::{CString, c_char};
use std::ptr;
use std::sync::{Mutex, PoisonError};

use opendr::vision::Source;

use crate::handle::{self, Held, Out};
use crate::pointer::path;
use crate::status::{guard, guard_value, opendr_status};
use crate::value::{AnyValue, opendr_image};

/// A sequence of images; calls from several threads are serialised.
pub struct opendr_source(());

struct Images(Mutex<(Source, CString)>);

impl Held for Images {
    const NAME: &'static str = "opendr_source";
    const MAGIC: u64 = u64::from_le_bytes(*b"ODRsourc");
}

/// Opens an image, a folder, a pattern ("photos/\*.jpg"), a video, or a camera ("camera:0").
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_source_open(
    input: *const c_char,
    source: *mut *mut opendr_source,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, input) = unsafe { (Out::new(source, "source")?, path(input, "input")?) };
        out.set(Images(Mutex::new((Source::open(input)?, CString::default()))));
        Ok(())
    })
}

/// Reads the next image, which must be freed; *image is NULL at the end. After a file that cannot be read, the next call
/// continues with the next file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_source_next(
    source: *mut opendr_source,
    image: *mut *mut opendr_image,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, source) =
            unsafe { (Out::new(image, "image")?, handle::held::<Images, _>(source, "source")?) };
        let (source, path) = &mut *source.0.lock().unwrap_or_else(PoisonError::into_inner);
        let next = source.next();
        let bytes = source.current_path().map_or(&[][..], |path| path.as_os_str().as_encoded_bytes());
        *path = CString::new(bytes).unwrap_or_default();
        if let Some(frame) = next.transpose()? {
            out.set(AnyValue::from(frame.image));
        }
        Ok(())
    })
}

/// Returns the file of the last image or the last failure; "" for a camera, and before the first image. Valid until the next
/// call with this source.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_source_path(source: *const opendr_source) -> *const c_char {
    guard_value(ptr::null(), || {
        // SAFETY: the rules at the top of opendr.h.
        let source = unsafe { handle::held::<Images, _>(source, "source") }?;
        Ok(source.0.lock().unwrap_or_else(PoisonError::into_inner).1.as_ptr())
    })
}

/// Closes the source and sets the variable to NULL; does nothing if it is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_source_free(source: *mut *mut opendr_source) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { handle::free::<Images, _>(source, "source") })
}
