//! Spoken commands.

use std::ffi::c_char;

use opendr::target::{Classes, SpeechCommand};

use crate::handle::Out;
use crate::pointer::{place, reference};
use crate::status::{guard, opendr_status};
use crate::target::{check_finite, class_of_name, name_of_class};
use crate::value::{AnyValue, opendr_speech_command};

/// The fields of a spoken command.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_speech_command_fields {
    /// Class index; -1 if there is only a word.
    pub class_index: i64,
    /// The word; NULL when unknown. In fields given to a command, it is used when class_index is -1.
    pub label: *const c_char,
    /// Score, 0 to 1.
    pub confidence: f32,
    /// Start within the audio, seconds; NaN when unknown.
    pub begin_s: f32,
    /// End within the audio, seconds; NaN when unknown.
    pub end_s: f32,
}

/// Creates a command; the fields are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_speech_command_create(
    fields: *const opendr_speech_command_fields,
    command: *mut *mut opendr_speech_command,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, fields) = unsafe { (Out::new(command, "command")?, reference(fields, "fields")?) };
        check_finite(&[fields.confidence], "the score of a command")?;
        // SAFETY: the rules at the top of opendr.h.
        let name = unsafe { name_of_class(fields.class_index, fields.label) }?;
        let span_s =
            (!fields.begin_s.is_nan() && !fields.end_s.is_nan()).then_some([fields.begin_s, fields.end_s]);
        out.set(AnyValue::from(SpeechCommand { span_s, ..SpeechCommand::new(name, fields.confidence) }));
        Ok(())
    })
}

/// Writes the fields of a command; the word is valid as long as the command.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_speech_command_read(
    command: *const opendr_speech_command,
    fields: *mut opendr_speech_command_fields,
) -> opendr_status {
    guard(|| {
        let place = place(fields, "fields")?;
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { AnyValue::of(command, "command") }?;
        let command = value.typed::<SpeechCommand>("command")?;
        let (class_index, label) = class_of_name(&command.command, &Classes::default(), &value.texts);
        let [begin_s, end_s] = command.span_s.unwrap_or([f32::NAN; 2]);
        let confidence = command.confidence;
        // SAFETY: the rules at the top of opendr.h.
        unsafe {
            place.write(opendr_speech_command_fields { class_index, label, confidence, begin_s, end_s })
        };
        Ok(())
    })
}
