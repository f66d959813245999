//! A value of a JSON text with its position in the file.

use serde::Deserialize;

use crate::{Error, Result};

/// The bytes of one JSON value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JsonPiece<'a> {
    /// The text of the value.
    pub bytes: &'a [u8],
    /// Position of the value in the file, in bytes.
    pub offset: u64,
    /// Line on which the value begins, from 1.
    pub line: u64,
}

impl<'a> JsonPiece<'a> {
    /// Parses the value.
    ///
    /// # Errors
    /// Returns `Format` with line, byte and key: `line 3, byte 120, key "bbox[2]": ...`.
    pub fn parse<T: Deserialize<'a>>(&self) -> Result<T> {
        serde_json::from_slice(self.bytes).map_err(|error| {
            let text = error.to_string();
            let what = text.rsplit_once(" at line ").map_or(text.as_str(), |(what, _)| what);
            self.error_at(self.place(&error), what)
        })
    }

    /// Creates an error at byte `place` of the value: `line 3, byte 120, key "bbox[2]": ...`.
    pub fn error_at(&self, place: usize, what: &str) -> Error {
        let place = place.min(self.bytes.len());
        let lines = self.bytes[..place].iter().filter(|byte| **byte == b'\n').count();
        let (offset, line) = (self.offset + place as u64, self.line + lines as u64);
        let path = path_at(self.bytes, place);
        let key = if path.is_empty() { path } else { format!(", key {path:?}") };
        Error::format(format!("line {line}, byte {offset}{key}: {what}"))
    }

    /// Returns the byte of the value at which `error` occurred.
    fn place(&self, error: &serde_json::Error) -> usize {
        let lines = self.bytes.split_inclusive(|byte| *byte == b'\n');
        let before: usize = lines.take(error.line().max(1) - 1).map(<[u8]>::len).sum();
        (before + error.column().saturating_sub(1)).min(self.bytes.len())
    }
}

/// Current key or index in an open object or array.
enum Place {
    Key(String),
    Index(usize),
}

/// Returns the path of keys to byte `end` of a JSON text: `segmentation[0][3]`.
fn path_at(bytes: &[u8], end: usize) -> String {
    let (mut open, mut at) = (Vec::new(), 0);
    while at < end {
        match bytes[at] {
            b'{' => open.push(Place::Key(String::new())),
            b'[' => open.push(Place::Index(0)),
            b'}' | b']' => {
                open.pop();
            }
            b',' => match open.last_mut() {
                Some(Place::Index(index)) => *index += 1,
                Some(Place::Key(key)) => key.clear(),
                None => {}
            },
            b'"' => {
                let text = string(&bytes[at + 1..]);
                if let Some(Place::Key(key)) = open.last_mut()
                    && key.is_empty()
                {
                    *key = String::from_utf8_lossy(text).chars().take(40).collect();
                }
                at += text.len() + 1;
            }
            _ => {}
        }
        at += 1;
    }
    let mut path = String::new();
    for place in &open {
        match place {
            Place::Key(key) if path.is_empty() || key.is_empty() => path.push_str(key),
            Place::Key(key) => path.extend([".", key]),
            Place::Index(index) => path.push_str(&format!("[{index}]")),
        }
    }
    path
}

/// Returns the text before the closing quotation mark.
fn string(text: &[u8]) -> &[u8] {
    let mut escaped = false;
    let length = text.iter().position(|byte| {
        let closing = *byte == b'"' && !escaped;
        escaped = *byte == b'\\' && !escaped;
        closing
    });
    &text[..length.unwrap_or(text.len())]
}
