//! Transcriptions of speech.

use std::ffi::c_char;
use std::ptr;

use opendr::target::{BaseTranscription, VoskTranscription, WhisperSegment, WhisperTranscription};
use opendr::{Datum, Error, Result};

use crate::handle::Out;
use crate::pointer::{place, slice, text};
use crate::status::{guard, guard_value, opendr_status};
use crate::value::{
    AnyValue, opendr_base_transcription, opendr_vosk_transcription, opendr_whisper_transcription,
};

/// A segment of a transcription. Tokens and scores are in the JSON of the transcription.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_whisper_segment {
    /// Index of the segment.
    pub id: i64,
    /// Start within the audio, seconds.
    pub start_s: f32,
    /// End within the audio, seconds.
    pub end_s: f32,
    /// The text.
    pub text: *const c_char,
}

/// Creates a transcription from its text.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_base_transcription_create(
    text: *const c_char,
    transcription: *mut *mut opendr_base_transcription,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, text) = unsafe { (Out::new(transcription, "transcription")?, self::text(text, "text")?) };
        out.set(AnyValue::from(BaseTranscription { text: text.to_owned(), ..BaseTranscription::default() }));
        Ok(())
    })
}

/// Returns the text, or NULL if the handle is not such a transcription; valid as long as the transcription.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_base_transcription_text(
    transcription: *const opendr_base_transcription,
) -> *const c_char {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(ptr::null(), || unsafe {
        text_of(transcription, |transcription: &BaseTranscription| &transcription.text)
    })
}

/// Creates an intermediate or final transcription of a streaming recogniser; finished is whether the phrase is final.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_vosk_transcription_create(
    text: *const c_char,
    finished: bool,
    transcription: *mut *mut opendr_vosk_transcription,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, text) = unsafe { (Out::new(transcription, "transcription")?, self::text(text, "text")?) };
        let (text, accept_waveform) = (text.to_owned(), finished);
        out.set(AnyValue::from(VoskTranscription { text, accept_waveform, ..VoskTranscription::default() }));
        Ok(())
    })
}

/// Returns the text so far, or NULL if the handle is not such a transcription; valid as long as the transcription.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_vosk_transcription_text(
    transcription: *const opendr_vosk_transcription,
) -> *const c_char {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(ptr::null(), || unsafe {
        text_of(transcription, |transcription: &VoskTranscription| &transcription.text)
    })
}

/// Returns whether the phrase is final: its text will not change any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_vosk_transcription_finished(
    transcription: *const opendr_vosk_transcription,
) -> bool {
    guard_value(false, || {
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { AnyValue::of(transcription, "transcription") }?;
        Ok(value.typed::<VoskTranscription>("transcription")?.accept_waveform)
    })
}

/// Creates a transcription from its text and segments, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_whisper_transcription_create(
    text: *const c_char,
    segments: *const opendr_whisper_segment,
    count: usize,
    transcription: *mut *mut opendr_whisper_transcription,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, text, segments) = unsafe {
            (
                Out::new(transcription, "transcription")?,
                self::text(text, "text")?,
                slice(segments, count, "segments")?,
            )
        };
        // SAFETY: the rules at the top of opendr.h.
        let segments =
            segments.iter().map(|segment| unsafe { segment.to_segment() }).collect::<Result<_>>()?;
        let text = text.to_owned();
        out.set(AnyValue::from(WhisperTranscription { text, segments, ..WhisperTranscription::default() }));
        Ok(())
    })
}

/// Returns the text, or NULL if the handle is not such a transcription; valid as long as the transcription.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_whisper_transcription_text(
    transcription: *const opendr_whisper_transcription,
) -> *const c_char {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(ptr::null(), || unsafe {
        text_of(transcription, |transcription: &WhisperTranscription| &transcription.text)
    })
}

/// Returns the number of segments; 0 if the handle is not such a transcription.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_whisper_transcription_count(
    transcription: *const opendr_whisper_transcription,
) -> usize {
    guard_value(0, || {
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { AnyValue::of(transcription, "transcription") }?;
        Ok(value.typed::<WhisperTranscription>("transcription")?.segments.len())
    })
}

/// Writes a segment into segment; its text is valid as long as the transcription.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_whisper_transcription_get(
    transcription: *const opendr_whisper_transcription,
    index: usize,
    segment: *mut opendr_whisper_segment,
) -> opendr_status {
    guard(|| {
        let place = place(segment, "segment")?;
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { AnyValue::of(transcription, "transcription") }?;
        let segments = &value.typed::<WhisperTranscription>("transcription")?.segments;
        let WhisperSegment { id, start, end, text, .. } = segments.get(index).ok_or_else(|| {
            let count = segments.len();
            Error::invalid_input(format!(
                "segment {index} is out of range; the transcription has {count} segments"
            ))
        })?;
        let text = value.texts.keep(text);
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(opendr_whisper_segment { id: *id, start_s: *start, end_s: *end, text }) };
        Ok(())
    })
}

/// # Safety
/// The same as for [`crate::handle::held`].
unsafe fn text_of<D: Datum, P>(transcription: *const P, text: impl Fn(&D) -> &str) -> Result<*const c_char> {
    // SAFETY: the caller's promise.
    let value = unsafe { AnyValue::of(transcription, "transcription") }?;
    Ok(value.texts.keep(text(value.typed("transcription")?)))
}

impl opendr_whisper_segment {
    /// # Safety
    /// `text` points to a text.
    unsafe fn to_segment(self) -> Result<WhisperSegment> {
        // SAFETY: the caller's promise.
        let text = unsafe { text(self.text, "the text of a segment") }?.to_owned();
        Ok(WhisperSegment {
            id: self.id,
            start: self.start_s,
            end: self.end_s,
            text,
            ..WhisperSegment::default()
        })
    }
}
