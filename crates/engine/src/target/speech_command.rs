//! Spoken commands.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::numpy_text::python_float;
use crate::target::json_number::null_as_nan;
use crate::target::{Action, Classes, Name};

/// A recognised spoken command (of the paper; OpenDR 3.0 returns a `Category` instead).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SpeechCommand {
    /// Header of the audio.
    #[serde(flatten)]
    pub header: Header,
    /// Class index or word.
    pub command: Name,
    /// Score, 0..=1.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub confidence: f32,
    /// Start and end within the audio, in seconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub span_s: Option<[f32; 2]>,
    /// Proposed motion for better audio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

impl SpeechCommand {
    /// Creates a command without its time.
    pub fn new(command: impl Into<Name>, confidence: f32) -> Self {
        Self { command: command.into(), confidence, ..Self::default() }
    }
}

target!(SpeechCommand, |command| Some(command.confidence));

impl fmt::Display for SpeechCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() {
            return write!(f, "Command {} with confidence {}", self.command, python_float(self.confidence));
        }
        Classes::default().write_label(&self.command, f)?;
        write!(f, " {:.2}", self.confidence)?;
        match self.span_s {
            Some([begin, end]) => writeln!(f, " from {begin:.2} s to {end:.2} s"),
            None => writeln!(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts() {
        let command = SpeechCommand { span_s: Some([0.5, 1.0]), ..SpeechCommand::new("stop", 0.75) };
        assert_eq!(command.to_string(), "Command stop with confidence 0.75");
        assert_eq!(format!("{command:#}"), "stop 0.75 from 0.50 s to 1.00 s\n");
    }
}
