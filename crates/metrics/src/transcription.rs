//! Transcriptions: word and character error rates, equal to jiwer 4.

use std::borrow::Cow;

use opendr_engine::params::Params;
use opendr_engine::target::BaseTranscription;
use opendr_engine::{Error, Result, ValueRef};

use crate::average::ratio;
use crate::generated::punctuation::PUNCTUATION;
use crate::{EditCounts, Metric, Report};

/// Most characters of one text: comparing two that have nothing in common takes the square of it.
const MAX_CHARACTERS: usize = 1 << 17;

/// What is done to both texts before they are compared. Without any of it they are taken as jiwer's defaults take them:
/// words are parted by spaces and by runs of two or more white characters.
#[derive(Debug, Clone, Params)]
pub struct TranscriptionParams {
    /// Make all letters small (Unicode's lower case).
    pub lower_case: bool,
    /// Drop punctuation (Unicode's categories P); nothing takes its place: "it's" becomes "its".
    pub drop_punctuation: bool,
    /// Make every run of white characters, line breaks and tabs among them, one space.
    pub join_whitespace: bool,
}

impl TranscriptionParams {
    /// `text` as it is compared, white characters at its ends cut off.
    pub fn normalized(&self, text: &str) -> String {
        let mut text = Cow::Borrowed(text);
        if self.lower_case {
            text = text.to_lowercase().into();
        }
        if self.drop_punctuation {
            text = text.chars().filter(|character| !is_punctuation(*character)).collect::<String>().into();
        }
        if self.join_whitespace {
            text = text.split(is_white).filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ").into();
        }
        text.trim_matches(is_white).to_owned()
    }
}

/// Python's `str.isspace`: Unicode's white space and four control characters.
fn is_white(character: char) -> bool {
    character.is_whitespace() || ('\x1c'..='\x1f').contains(&character)
}

fn is_punctuation(character: char) -> bool {
    let at = PUNCTUATION.partition_point(|(_, last)| *last < character);
    PUNCTUATION.get(at).is_some_and(|(first, _)| *first <= character)
}

/// The words of `text`: between spaces, or two and more white characters; a single tab or line break parts none.
pub fn words_of_text(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let (mut start, mut white) = (0, None::<(usize, usize)>);
    for (at, character) in text.char_indices().chain([(text.len(), 'x')]) {
        if is_white(character) {
            let (begin, count) = white.unwrap_or((at, 0));
            white = Some((begin, count + 1));
            continue;
        }
        if let Some((begin, count)) = white.take()
            && (count > 1 || text[begin..].starts_with(' '))
        {
            words.push(&text[start..begin]);
            start = at;
        }
    }
    words.push(&text[start..]);
    words.retain(|word| !word.is_empty());
    words
}

/// Counts edits of words and of characters over all utterances: rates are those of the whole corpus.
#[derive(Debug, Clone, Default)]
pub struct Transcription {
    params: TranscriptionParams,
    words: EditCounts,
    characters: EditCounts,
    utterances: u64,
    wrong_utterances: u64,
}

impl Transcription {
    /// Counts one utterance and gives its edits of words.
    ///
    /// # Errors
    /// `InvalidInput` for a text of more than 2^17 characters.
    pub fn add(&mut self, reference: &str, hypothesis: &str) -> Result<EditCounts> {
        for text in [reference, hypothesis] {
            let count = text.chars().count();
            if count > MAX_CHARACTERS {
                return Err(Error::invalid_input(format!(
                    "a transcription of {count} characters is too long; give utterances of at most {MAX_CHARACTERS}"
                )));
            }
        }
        let (reference, hypothesis) = (self.params.normalized(reference), self.params.normalized(hypothesis));
        let words = EditCounts::of(&words_of_text(&reference), &words_of_text(&hypothesis));
        let [wanted, given] = [&reference, &hypothesis].map(|text| text.chars().collect::<Vec<_>>());
        self.words.add(&words);
        self.characters.add(&EditCounts::of(&wanted, &given));
        self.utterances += 1;
        self.wrong_utterances += u64::from(words.errors() > 0);
        Ok(words)
    }

    /// Edits of words.
    pub fn words(&self) -> &EditCounts {
        &self.words
    }

    /// Edits of characters, spaces among them.
    pub fn characters(&self) -> &EditCounts {
        &self.characters
    }
}

impl EditCounts {
    fn reference(&self) -> u64 {
        self.hits + self.substitutions + self.deletions
    }

    fn hypothesis(&self) -> u64 {
        self.hits + self.substitutions + self.insertions
    }

    /// Edits for each symbol of the reference (WER of words, CER of characters); where the reference is empty, the
    /// number of insertions, as jiwer.
    pub fn error_rate(&self) -> f64 {
        ratio(self.errors(), self.reference()).unwrap_or(self.insertions as f64)
    }

    /// Edits for each symbol of the alignment (MER, Morris et al., 2004); 0 of two empty texts.
    pub fn match_error_rate(&self) -> f64 {
        ratio(self.errors(), self.reference() + self.insertions).unwrap_or(0.0)
    }

    /// Share of the reference that is right times share of the hypothesis that is right (WIP); 1 of two empty texts.
    pub fn information_preserved(&self) -> f64 {
        match (ratio(self.hits, self.reference()), ratio(self.hits, self.hypothesis())) {
            (Some(found), Some(right)) => found * right,
            (None, None) => 1.0,
            _ => 0.0,
        }
    }
}

/// Predictions and truths may be any transcription, or a spoken command whose word is the text.
impl Metric for Transcription {
    const NAME: &'static str = "transcription";
    const ABOUT: &'static str = "WER, CER, MER and WIL of transcriptions, as jiwer";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("wer", "Word error rate: (substitutions + deletions + insertions) / words of the truth."),
        ("cer", "The same of characters."),
        ("mer", "Match error rate: errors / all that was aligned."),
        ("wil", "Word information lost."),
        ("wip", "Word information preserved."),
        ("utterance_error_rate", "Share of utterances with any error."),
        ("utterances", "How many were counted."),
        ("word_<count>", "Hits, substitutions, deletions, insertions of words."),
        ("character_<count>", "The same of characters."),
    ];
    const ERRORS: &'static [&'static str] = &["wer", "cer", "mer", "wil", "utterance_error_rate"];
    type Params = TranscriptionParams;
    type Prediction = BaseTranscription;
    type Truth = BaseTranscription;

    fn new(params: &TranscriptionParams) -> Result<Self> {
        Ok(Self { params: params.clone(), ..Self::default() })
    }

    fn update(
        &mut self,
        _at: usize,
        prediction: &BaseTranscription,
        truth: &BaseTranscription,
    ) -> Result<f64> {
        let words = self.add(&truth.text, &prediction.text)?;
        Ok(1.0 - words.error_rate().min(1.0))
    }

    fn merge(&mut self, other: Self) {
        self.words.add(&other.words);
        self.characters.add(&other.characters);
        self.utterances += other.utterances;
        self.wrong_utterances += other.wrong_utterances;
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("wer");
        report.statistics.set("utterances", self.utterances as f64);
        let Some(wrong) = ratio(self.wrong_utterances, self.utterances) else { return report };
        let preserved = self.words.information_preserved();
        let numbers = [
            ("wer", self.words.error_rate()),
            ("mer", self.words.match_error_rate()),
            ("wip", preserved),
            ("wil", 1.0 - preserved),
            ("cer", self.characters.error_rate()),
            ("utterance_error_rate", wrong),
        ];
        numbers.into_iter().for_each(|(key, value)| report.statistics.set(key, value));
        for (of, counts) in [("word", &self.words), ("character", &self.characters)] {
            let EditCounts { hits, substitutions, deletions, insertions } = *counts;
            report.statistics.set(format!("{of}_hits"), hits as f64);
            report.statistics.set(format!("{of}_substitutions"), substitutions as f64);
            report.statistics.set(format!("{of}_deletions"), deletions as f64);
            report.statistics.set(format!("{of}_insertions"), insertions as f64);
        }
        report
    }

    fn prediction(value: ValueRef<'_>) -> Option<Cow<'_, BaseTranscription>> {
        let text = match value {
            ValueRef::BaseTranscription(transcription) => return Some(Cow::Borrowed(transcription)),
            ValueRef::WhisperTranscription(transcription) => transcription.text.clone(),
            ValueRef::VoskTranscription(transcription) => transcription.text.clone(),
            ValueRef::SpeechCommand(command) => command.command.to_string(),
            _ => return None,
        };
        Some(Cow::Owned(BaseTranscription { text, ..BaseTranscription::default() }))
    }

    fn truth(value: ValueRef<'_>) -> Option<Cow<'_, BaseTranscription>> {
        Self::prediction(value)
    }
}

#[cfg(test)]
mod tests;
