//! Annotation files in MIT format: beats and other events with their time.

use opendr_engine::{Error, Result};

/// Symbols of annotation types by code, as in PhysioNet; a blank if there is none.
const SYMBOLS: &[u8; 42] = b" NLRaVFJASEj/Q~ | sT*D\"=pB^t+u?![]en@xf()r";
/// Codes of words that extend the preceding annotation.
const SKIP: u8 = 59;
const NUM: u8 = 60;
const SUB: u8 = 61;
const CHN: u8 = 62;
const AUX: u8 = 63;
const NOTE: u8 = 22;
const MAX_CODE: u8 = 49;

/// An annotation.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct WfdbAnnotation {
    /// Sample index, from 0.
    pub sample: i64,
    /// Type code: 1 is a normal beat.
    pub code: u8,
    /// Subtype.
    pub subtype: i8,
    /// Index of the signal.
    pub channel: u8,
    /// Number that is free for use by the annotator.
    pub number: i8,
    /// Text, e.g. a rhythm.
    pub text: String,
}

impl WfdbAnnotation {
    /// Returns the symbol of the type in PhysioNet, e.g. `N`; `None` for types without one.
    pub fn symbol(&self) -> Option<char> {
        SYMBOLS.get(usize::from(self.code)).map(|symbol| char::from(*symbol)).filter(|symbol| *symbol != ' ')
    }
}

/// Parses an annotation file in MIT format. Definitions (notes at the start that begin with `##`) are skipped.
///
/// # Errors
/// The byte offset and a message.
pub fn annotations_from_atr(bytes: &[u8]) -> Result<Vec<WfdbAnnotation>, (u64, String)> {
    let mut annotations: Vec<WfdbAnnotation> = Vec::new();
    let (mut at, mut sample) = (0usize, 0i64);
    let (mut channel, mut number) = (0, 0);
    let truncated = |at: usize| (at as u64, "the file is truncated; download it again".to_owned());
    loop {
        let word = |at: usize| Some(u16::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
        let first = word(at).ok_or_else(|| truncated(at))?;
        let (code, low) = ((first >> 10) as u8, first & 0x3ff);
        at += 2;
        let last = annotations.last_mut();
        match (code, last) {
            (0, _) if low == 0 => break,
            (SKIP, _) => {
                // A long integer of the PDP-11: the upper word comes first.
                let (high, low) = word(at).zip(word(at + 2)).ok_or_else(|| truncated(at))?;
                sample += i64::from((u32::from(high) << 16 | u32::from(low)) as i32);
                at += 4;
            }
            (0..=MAX_CODE, _) => {
                sample += i64::from(low);
                let annotation =
                    WfdbAnnotation { sample, code, channel, number, ..WfdbAnnotation::default() };
                annotations.push(annotation);
            }
            (NUM, Some(last)) => {
                number = low as i8;
                last.number = number;
            }
            (SUB, Some(last)) => last.subtype = low as i8,
            (CHN, Some(last)) => {
                channel = low as u8;
                last.channel = channel;
            }
            (AUX, Some(last)) => {
                let length = usize::from(low);
                let text = bytes.get(at..at + length).ok_or_else(|| truncated(at))?;
                last.text = String::from_utf8_lossy(text).trim_end_matches('\0').to_owned();
                at += length + length % 2;
            }
            (code, _) => {
                return Err((
                    at as u64 - 2,
                    format!("code {code} is not an annotation; the file is damaged"),
                ));
            }
        }
    }
    let definitions = annotations
        .iter()
        .take_while(|note| note.sample == 0 && note.code == NOTE && note.text.starts_with("##"))
        .count();
    annotations.drain(..definitions);
    if let Some(pair) = annotations.windows(2).find(|pair| pair[1].sample < pair[0].sample) {
        return Err((
            0,
            format!("sample {} follows {}; the file is damaged", pair[1].sample, pair[0].sample),
        ));
    }
    Ok(annotations)
}

/// Returns the bytes of an annotation file in MIT format.
///
/// # Errors
/// `InvalidInput` for annotations that are not in order of time, or have over 255 bytes of text.
pub fn atr_from_annotations(annotations: &[WfdbAnnotation]) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let (mut before, mut channel, mut number) = (0, 0, 0);
    for annotation in annotations {
        let WfdbAnnotation { sample, code, text, .. } = annotation;
        let step =
            u32::try_from(sample - before).ok().filter(|_| (1..=MAX_CODE).contains(code) && text.len() < 256);
        let step = step.ok_or_else(|| {
            Error::invalid_input(format!(
                "annotation {code} at sample {sample} after {before}; annotations need codes 1 to {MAX_CODE} in order of time"
            ))
        })?;
        let mut word = |code: u8, low: u16| bytes.extend((u16::from(code) << 10 | low & 0x3ff).to_le_bytes());
        match u16::try_from(step) {
            Ok(step @ ..0x400) => word(*code, step),
            _ => {
                word(SKIP, 0);
                bytes.extend(((step >> 16) as u16).to_le_bytes());
                bytes.extend((step as u16).to_le_bytes());
                bytes.extend((u16::from(*code) << 10).to_le_bytes());
            }
        }
        let mut word = |code: u8, low: u16| bytes.extend((u16::from(code) << 10 | low & 0x3ff).to_le_bytes());
        if annotation.subtype != 0 {
            word(SUB, annotation.subtype as u8 as u16);
        }
        if annotation.channel != channel {
            channel = annotation.channel;
            word(CHN, channel.into());
        }
        if annotation.number != number {
            number = annotation.number;
            word(NUM, number as u8 as u16);
        }
        if !text.is_empty() {
            word(AUX, text.len() as u16);
            bytes.extend(text.as_bytes());
            bytes.extend((text.len() % 2 == 1).then_some(0));
        }
        before = *sample;
    }
    bytes.extend([0, 0]);
    Ok(bytes)
}
