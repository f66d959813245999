//! Transcriptions: `opendr_msgs/Transcription`.

use opendr_engine::Result;
use opendr_engine::target::{BaseTranscription, VoskTranscription, WhisperSegment, WhisperTranscription};
use opendr_messages::opendr_msgs::{Transcription, TranscriptionSegment};

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// The text.
impl FromToMessage<Transcription> for BaseTranscription {
    fn from_message(message: Transcription, _: &RosBridge) -> Result<Self> {
        Ok(Self { header: header_from_message(&message.header), text: message.text, action: None })
    }

    fn to_message(&self, _: &RosBridge) -> Result<Transcription> {
        let header = message_from_header(&self.header)?;
        Ok(Transcription { header, text: self.text.clone(), is_final: true, ..Default::default() })
    }
}

/// The text so far, and whether it is final.
impl FromToMessage<Transcription> for VoskTranscription {
    fn from_message(message: Transcription, _: &RosBridge) -> Result<Self> {
        let header = header_from_message(&message.header);
        Ok(Self { header, text: message.text, accept_waveform: message.is_final, action: None })
    }

    fn to_message(&self, _: &RosBridge) -> Result<Transcription> {
        let header = message_from_header(&self.header)?;
        let (text, is_final) = (self.text.clone(), self.accept_waveform);
        Ok(Transcription { header, text, is_final, ..Default::default() })
    }
}

/// The text with its segments.
impl FromToMessage<Transcription> for WhisperTranscription {
    fn from_message(message: Transcription, _: &RosBridge) -> Result<Self> {
        let segments = message.segments.into_iter().map(segment_from_message).collect();
        Ok(Self { header: header_from_message(&message.header), text: message.text, segments, action: None })
    }

    fn to_message(&self, _: &RosBridge) -> Result<Transcription> {
        Ok(Transcription {
            header: message_from_header(&self.header)?,
            text: self.text.clone(),
            is_final: true,
            segments: self.segments.iter().map(message_from_segment).collect(),
            ..Default::default()
        })
    }
}

fn message_from_segment(segment: &WhisperSegment) -> TranscriptionSegment {
    let WhisperSegment {
        id,
        seek,
        start,
        end,
        temperature,
        avg_logprob,
        compression_ratio,
        no_speech_prob,
        ..
    } = *segment;
    let (text, tokens) = (segment.text.clone(), segment.tokens.clone());
    TranscriptionSegment {
        id,
        seek,
        start,
        end,
        text,
        tokens,
        temperature,
        avg_logprob,
        compression_ratio,
        no_speech_prob,
    }
}

fn segment_from_message(message: TranscriptionSegment) -> WhisperSegment {
    let TranscriptionSegment {
        id,
        seek,
        start,
        end,
        text,
        tokens,
        temperature,
        avg_logprob,
        compression_ratio,
        no_speech_prob,
    } = message;
    WhisperSegment {
        id,
        seek,
        start,
        end,
        text,
        tokens,
        temperature,
        avg_logprob,
        compression_ratio,
        no_speech_prob,
    }
}
