//! Transcriptions: word and character error rates, equal to jiwer 4.

use std::borrow::Cow;

use opendr_engine::params::Params;
use opendr_engine::target::BaseTranscription;
use opendr_engine::{Error, Result, ValueRef};

use crate::average::ratio;
use crate::generated::punctuation::PUNCTUATION;
use crate::{EditCounts, Metric, Report};

/// Maximum number of characters of a text; the time for two unrelated texts grows with its square.
const MAX_CHARACTERS: usize = 1 << 17;

/// Normalisation of both texts before the comparison. The default is that of jiwer: words are separated by spaces and by
/// runs of two or more white-space characters.
#[derive(Debug, Clone, Params)]
pub struct TranscriptionParams {
    /// Whether to convert letters to lower case (Unicode).
    pub lower_case: bool,
    /// Whether to remove punctuation (Unicode's categories P) without replacement: "it's" becomes "its".
    pub drop_punctuation: bool,
    /// Whether to replace every run of white space, including line breaks and tabs, by one space.
    pub join_whitespace: bool,
}

impl TranscriptionParams {
    /// Returns the normalised text, without white space at its ends.
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

/// Returns the same as Python's `str.isspace`: Unicode's white space and four control characters.
fn is_white(character: char) -> bool {
    character.is_whitespace() || ('\x1c'..='\x1f').contains(&character)
}

fn is_punctuation(character: char) -> bool {
    let at = PUNCTUATION.partition_point(|(_, last)| *last < character);
    PUNCTUATION.get(at).is_some_and(|(first, _)| *first <= character)
}

/// Returns the words of `text`, separated by spaces or two and more white-space characters; a single tab or line break does
/// not separate words.
pub fn split_words(text: &str) -> Vec<&str> {
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

/// Accumulates edits of words and characters over all utterances; rates are those of the whole corpus.
#[derive(Debug, Clone, Default)]
pub struct Transcription {
    params: TranscriptionParams,
    words: EditCounts,
    characters: EditCounts,
    utterances: u64,
    wrong_utterances: u64,
}

impl Transcription {
    /// Adds an utterance and returns its edits of words.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a text of more than 2^17 characters.
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
        let words = EditCounts::of(&split_words(&reference), &split_words(&hypothesis));
        let [expected, given] = [&reference, &hypothesis].map(|text| text.chars().collect::<Vec<_>>());
        self.words.add(&words);
        self.characters.add(&EditCounts::of(&expected, &given));
        self.utterances += 1;
        self.wrong_utterances += u64::from(words.errors() > 0);
        Ok(words)
    }

    /// Returns the edits of words.
    pub fn words(&self) -> &EditCounts {
        &self.words
    }

    /// Returns the edits of characters, including spaces.
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

    /// Returns the edits per symbol of the reference (WER of words, CER of characters); for an empty reference the number of
    /// insertions, as jiwer does.
    pub fn error_rate(&self) -> f64 {
        ratio(self.errors(), self.reference()).unwrap_or(self.insertions as f64)
    }

    /// Returns the edits per symbol of the alignment (MER, Morris et al., 2004); 0 for two empty texts.
    pub fn match_error_rate(&self) -> f64 {
        ratio(self.errors(), self.reference() + self.insertions).unwrap_or(0.0)
    }

    /// Returns the fraction of correct symbols of the reference times that of the hypothesis (WIP); 1 for two empty texts.
    pub fn information_preserved(&self) -> f64 {
        match (ratio(self.hits, self.reference()), ratio(self.hits, self.hypothesis())) {
            (Some(found), Some(right)) => found * right,
            (None, None) => 1.0,
            _ => 0.0,
        }
    }
}

/// Predictions and ground truth may be any transcription, or a spoken command, whose word is the text.
impl Metric for Transcription {
    const NAME: &'static str = "transcription";
    const ABOUT: &'static str = "WER, CER, MER and WIL of transcriptions, as jiwer";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("wer", "Word error rate: (substitutions + deletions + insertions) / words of the ground truth."),
        ("cer", "Character error rate."),
        ("mer", "Match error rate: errors / aligned words."),
        ("wil", "Word information lost."),
        ("wip", "Word information preserved."),
        ("utterance_error_rate", "Fraction of utterances with errors."),
        ("utterances", "Number of utterances."),
        ("word_<count>", "Numbers of hits, substitutions, deletions and insertions of words."),
        ("character_<count>", "Numbers of hits, substitutions, deletions and insertions of characters."),
    ];
    const LOWER_IS_BETTER: &'static [&'static str] = &["wer", "cer", "mer", "wil", "utterance_error_rate"];
    type Params = TranscriptionParams;
    type Prediction = BaseTranscription;
    type GroundTruth = BaseTranscription;

    fn new(params: &TranscriptionParams) -> Result<Self> {
        Ok(Self { params: params.clone(), ..Self::default() })
    }

    fn update(
        &mut self,
        _at: usize,
        prediction: &BaseTranscription,
        ground_truth: &BaseTranscription,
    ) -> Result<f64> {
        let words = self.add(&ground_truth.text, &prediction.text)?;
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

    fn ground_truth(value: ValueRef<'_>) -> Option<Cow<'_, BaseTranscription>> {
        Self::prediction(value)
    }
}

#[cfg(test)]
mod tests;
