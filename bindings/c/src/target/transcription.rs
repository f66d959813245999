//! What was said.

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

/// A part of a transcription. Tokens and measures are in the JSON of the transcription.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_whisper_segment {
    /// Number of the segment.
    pub id: i64,
    /// Begin within the sound, seconds.
    pub start_s: f32,
    /// End within the sound, seconds.
    pub end_s: f32,
    /// The words.
    pub text: *const c_char,
}

/// Makes a transcription of words.
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

/// The words, NULL for what is no such transcription; they live as long as it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_base_transcription_text(
    transcription: *const opendr_base_transcription,
) -> *const c_char {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(ptr::null(), || unsafe { words(transcription, |said: &BaseTranscription| &said.text) })
}

/// Makes a transcription of words so far; finished tells whether the phrase is.
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

/// The words so far, NULL for what is no such transcription; they live as long as it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_vosk_transcription_text(
    transcription: *const opendr_vosk_transcription,
) -> *const c_char {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(ptr::null(), || unsafe { words(transcription, |said: &VoskTranscription| &said.text) })
}

/// Whether the phrase is finished: the words will not change any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_vosk_transcription_finished(
    transcription: *const opendr_vosk_transcription,
) -> bool {
    guard_value(false, || {
        // SAFETY: the rules at the top of opendr.h.
        let said = unsafe { AnyValue::of(transcription, "transcription") }?;
        Ok(said.typed::<VoskTranscription>("transcription")?.accept_waveform)
    })
}

/// Makes a transcription of words and its segments, which are copied.
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

/// The words, NULL for what is no such transcription; they live as long as it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_whisper_transcription_text(
    transcription: *const opendr_whisper_transcription,
) -> *const c_char {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(ptr::null(), || unsafe { words(transcription, |said: &WhisperTranscription| &said.text) })
}

/// How many segments there are; 0 for what is no such transcription.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_whisper_transcription_count(
    transcription: *const opendr_whisper_transcription,
) -> usize {
    guard_value(0, || {
        // SAFETY: the rules at the top of opendr.h.
        let said = unsafe { AnyValue::of(transcription, "transcription") }?;
        Ok(said.typed::<WhisperTranscription>("transcription")?.segments.len())
    })
}

/// Shows a segment; its words live as long as the transcription.
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
            Error::invalid_input(format!("there is no segment {index}; there are {count}, counted from 0"))
        })?;
        let text = value.texts.keep(text);
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(opendr_whisper_segment { id: *id, start_s: *start, end_s: *end, text }) };
        Ok(())
    })
}

/// # Safety
/// As [`crate::handle::held`].
unsafe fn words<D: Datum, P>(said: *const P, words: impl Fn(&D) -> &str) -> Result<*const c_char> {
    // SAFETY: the caller's promise.
    let said = unsafe { AnyValue::of(said, "transcription") }?;
    Ok(said.texts.keep(words(said.typed("transcription")?)))
}

impl opendr_whisper_segment {
    /// # Safety
    /// `text` is a text.
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
