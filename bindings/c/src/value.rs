//! Handles of data and targets of any type.

use std::ffi::c_char;
use std::ptr;

use opendr::{Datum, Error, Result, Value, ValueType};

use crate::handle::{self, Held, Out};
use crate::pointer::{self, optional_text, place, text};
use crate::status::{guard, guard_value, opendr_status};
use crate::string::{Text, opendr_string};
use crate::texts::Texts;

/// A datum or target of any type; a pointer to a handle of a data or target type can be cast to it.
pub struct opendr_value(());

macro_rules! typed {
    ($($name:ident)*) => {$(
        /// A handle of the type of its name.
        pub struct $name(());
    )*};
}

typed! {
    opendr_image opendr_image_with_detections opendr_video opendr_point_cloud opendr_point_cloud_with_calibration
    opendr_calibration opendr_timeseries opendr_vector opendr_audio opendr_skeleton_sequence opendr_observation
    opendr_bounding_box_list opendr_tracking_annotation_list opendr_bounding_box_3d_list
    opendr_tracking_annotation_3d_list opendr_pose_list opendr_category opendr_heatmap
    opendr_odometry opendr_text_region_list opendr_speech_command
    opendr_base_transcription opendr_whisper_transcription opendr_vosk_transcription opendr_rl_target
}

/// The time stamp of a value without one.
pub const OPENDR_NO_STAMP: i64 = i64::MIN;

/// The value of a handle of a datum or target.
pub(crate) struct AnyValue {
    pub(crate) value: Value,
    pub(crate) texts: Texts,
}

impl Held for AnyValue {
    const NAME: &'static str = "opendr_value";
    const MAGIC: u64 = u64::from_le_bytes(*b"ODRvalue");
}

impl<V: Into<Value>> From<V> for AnyValue {
    fn from(value: V) -> Self {
        Self { value: value.into(), texts: Texts::default() }
    }
}

impl AnyValue {
    /// Returns the value of a handle of any data or target type.
    ///
    /// # Safety
    /// The same as for [`handle::held`].
    pub(crate) unsafe fn of<'a, P>(value: *const P, name: &str) -> Result<&'a Self> {
        // SAFETY: the caller's promise.
        unsafe { handle::held(value, name) }
    }

    /// Returns the value, if it is of this type.
    pub(crate) fn typed<D: Datum>(&self, name: &str) -> Result<&D> {
        D::from_value_ref(self.value.as_value_ref()).ok_or_else(|| {
            let (expected, given) = (D::TYPE.name(), self.type_name());
            Error::invalid_input(format!("{name} takes a {expected}, not a {given}; give one"))
        })
    }

    fn type_name(&self) -> &'static str {
        self.value.as_value_ref().value_type().name()
    }
}

/// Returns the value of a handle of type `D`.
///
/// # Safety
/// The same as for [`handle::held`].
pub(crate) unsafe fn typed<'a, D: Datum, P>(value: *const P, name: &str) -> Result<&'a D> {
    // SAFETY: the caller's promise.
    unsafe { AnyValue::of(value, name) }?.typed(name)
}

/// Returns the name of the value's type, e.g. "BoundingBoxList", or NULL if the handle is not a value; valid as long as the
/// value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_type(value: *const opendr_value) -> *const c_char {
    guard_value(ptr::null(), || {
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { AnyValue::of(value, "value") }?;
        Ok(value.texts.keep(value.type_name()))
    })
}

/// Writes the JSON of a target (docs/json.md), which must be freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_to_json(
    value: *const opendr_value,
    json: *mut *mut opendr_string,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (json, value) = unsafe { (Out::new(json, "json")?, AnyValue::of(value, "value")?) };
        if !value.value.as_value_ref().value_type().is_target() {
            return Err(Error::unsupported(format!(
                "{} cannot be written as JSON; write it as a file",
                value.type_name()
            )));
        }
        let text = serde_json::to_string(&value.value)
            .map_err(|error| Error::internal("the value cannot be written as JSON").with_source(error))?;
        json.set(Text::new(text));
        Ok(())
    })
}

/// Reads a target from its JSON (docs/json.md). type_name is the expected type, or NULL for any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_from_json(
    type_name: *const c_char,
    json: *const c_char,
    value: *mut *mut opendr_value,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, expected, json) = unsafe {
            (Out::new(value, "value")?, optional_text(type_name, "type_name")?, text(json, "json")?)
        };
        let expected = expected.map(str::parse::<ValueType>).transpose()?;
        let value: Value = serde_json::from_str(json).map_err(|error| {
            Error::format("the JSON is not a target; see docs/json.md").with_source(error)
        })?;
        let value = AnyValue::from(value);
        match expected {
            Some(expected) if expected.name() != value.type_name() => Err(Error::invalid_input(format!(
                "the JSON is of a {}, not of a {}; give the expected type",
                value.type_name(),
                expected.name()
            ))),
            _ => {
                out.set(value);
                Ok(())
            }
        }
    })
}

/// Reads a file as a value of the named type: "Image" (JPEG, PNG, BMP, WebP), "Audio" (WAVE), "Timeseries" (a table of
/// numbers as CSV or text, one line per time step; or NPY), "PointCloud" (KITTI's scans), or the JSON of a target.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_open(
    type_name: *const c_char,
    path: *const c_char,
    value: *mut *mut opendr_value,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, kind, path) = unsafe {
            (Out::new(value, "value")?, text(type_name, "type_name")?, pointer::path(path, "path")?)
        };
        out.set(AnyValue::from(opendr::datasets::open_value(kind.parse()?, path)?));
        Ok(())
    })
}

/// Writes the text of the value for people, one line per item, which must be freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_to_text(
    value: *const opendr_value,
    string: *mut *mut opendr_string,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (string, value) = unsafe { (Out::new(string, "string")?, AnyValue::of(value, "value")?) };
        string.set(Text::new(format!("{:#}", value.value.as_value_ref())));
        Ok(())
    })
}

/// Writes the time stamp of the value in nanoseconds; OPENDR_NO_STAMP when unknown.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_stamp(value: *const opendr_value, stamp_ns: *mut i64) -> opendr_status {
    guard(|| {
        let stamp_ns = place(stamp_ns, "stamp_ns")?;
        // SAFETY: the rules at the top of opendr.h.
        unsafe {
            let value = AnyValue::of(value, "value")?;
            stamp_ns.write(value.value.header().stamp_ns.unwrap_or(OPENDR_NO_STAMP));
        }
        Ok(())
    })
}

/// Sets the time stamp of the value; OPENDR_NO_STAMP removes it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_set_stamp(value: *mut opendr_value, stamp_ns: i64) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { handle::held_mut::<AnyValue, _>(value, "value") }?;
        value.value.header_mut().stamp_ns = (stamp_ns != OPENDR_NO_STAMP).then_some(stamp_ns);
        Ok(())
    })
}

/// Returns the coordinate frame of the value, or NULL when unknown; valid as long as the value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_frame_id(value: *const opendr_value) -> *const c_char {
    guard_value(ptr::null(), || {
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { AnyValue::of(value, "value") }?;
        Ok(value.texts.keep_optional(value.value.header().frame_id.as_deref()))
    })
}

/// Sets the coordinate frame of the value; NULL removes it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_set_frame_id(
    value: *mut opendr_value,
    frame_id: *const c_char,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (frame_id, value) = unsafe {
            (optional_text(frame_id, "frame_id")?, handle::held_mut::<AnyValue, _>(value, "value")?)
        };
        value.value.header_mut().frame_id = frame_id.map(Into::into);
        Ok(())
    })
}

/// Creates another handle of the same value; large payloads are shared.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_copy(
    value: *const opendr_value,
    copy: *mut *mut opendr_value,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (copy, value) = unsafe { (Out::new(copy, "copy")?, AnyValue::of(value, "value")?) };
        copy.set(AnyValue::from(value.value.clone()));
        Ok(())
    })
}

/// Frees the value and sets the variable to NULL; does nothing if it is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_value_free(value: *mut *mut opendr_value) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { handle::free::<AnyValue, _>(value, "value") })
}
