//! Special tokens of Whisper.

use opendr_engine::{Error, Result};

use super::tokenizer::Tokenizer;

/// Number of timestamps: steps of 20 ms in a window of 30 s, both ends included.
const TIMES: u32 = 1501;

/// Minimum number of tokens of a multilingual Whisper.
const MULTILINGUAL: usize = 51_865;

/// Symbols that are not spoken (openai/whisper's `non_speech_tokens`), and those of which the first token is suppressed.
const SIGNS: &str = "\" # ( ) * + / : ; < = > @ [ \\ ] ^ _ ` { | } ~ 「 」 『 』 << >> <<< >>> -- --- -( -[ (' (\" (( )) ((( ))) \
                     [[ ]] {{ }} ♪♪ ♪♪♪";
const NOTES: [&str; 7] = ["♩", "♪", "♫", "♬", "♭", "♮", "♯"];

/// The tokenizer, and the tokens that are no text.
pub struct Vocabulary {
    pub tokenizer: Tokenizer,
    /// End of a text; all tokens below it are text.
    pub end: u32,
    /// Start of a transcript.
    pub start: u32,
    /// Start of the previous text (prompt).
    pub previous: u32,
    transcribe: u32,
    /// No speech.
    pub no_speech: u32,
    /// No timestamps.
    pub no_times: u32,
    /// Timestamp zero; the others follow it, 20 ms each.
    pub first_time: u32,
    languages: Vec<(String, u32)>,
    /// Tokens with which a text must not begin.
    pub blank: Vec<u32>,
    /// Symbols and special tokens that no transcript contains.
    pub unspoken: Vec<u32>,
}

impl Vocabulary {
    /// Returns the special tokens of a decoder with `count` tokens.
    ///
    /// # Errors
    /// `Format` when the tokenizer is not Whisper's or does not match the decoder.
    pub fn new(tokenizer: Tokenizer, count: usize) -> Result<Self> {
        let special = |name: &str| {
            let missing =
                || Error::format(format!("tokenizer.json has no token {name}, so it is not Whisper's"));
            tokenizer.special(name).ok_or_else(missing)
        };
        let no_speech = special("<|nocaptions|>").or_else(|_| special("<|nospeech|>"))?;
        let (end, start, no_times) =
            (special("<|endoftext|>")?, special("<|startoftranscript|>")?, special("<|notimestamps|>")?);
        let (transcribe, translate) = (special("<|transcribe|>")?, special("<|translate|>")?);
        let (previous, lm) = (special("<|startofprev|>")?, special("<|startoflm|>")?);
        let first_time = no_times + 1;
        let last = first_time + TIMES;
        if end > start || start > no_times || last as usize > count || tokenizer.len() > count {
            return Err(Error::format(format!(
                "tokenizer.json has {} tokens and timestamps up to {last}, but the decoder has {count} tokens",
                tokenizer.len()
            )));
        }
        let mut languages: Vec<(String, u32)> = tokenizer
            .specials()
            .filter(|(_, id)| (start + 1..transcribe.min(translate)).contains(id))
            .filter_map(|(name, id)| Some((name.strip_prefix("<|")?.strip_suffix("|>")?.to_owned(), id)))
            .collect();
        languages.sort_by_key(|(_, id)| *id);
        if count < MULTILINGUAL {
            languages.clear();
        }
        let mut blank = tokenizer.tokens(" ")?;
        blank.push(end);
        let mut unspoken = unspoken_signs(&tokenizer)?;
        unspoken.extend([transcribe, translate, start, previous, lm, no_speech]);
        unspoken.sort_unstable();
        unspoken.dedup();
        Ok(Self {
            tokenizer,
            end,
            start,
            previous,
            transcribe,
            no_speech,
            no_times,
            first_time,
            languages,
            blank,
            unspoken,
        })
    }

    /// Returns whether the model is multilingual.
    pub fn is_multilingual(&self) -> bool {
        !self.languages.is_empty()
    }

    /// Returns the tokens of all languages; empty for an English-only model.
    pub fn languages(&self) -> impl Iterator<Item = u32> {
        self.languages.iter().map(|(_, id)| *id)
    }

    /// Returns the token of a language; `None` for English in an English-only model.
    ///
    /// # Errors
    /// `InvalidParam` for an unknown language.
    pub fn language(&self, name: &str) -> Result<Option<u32>> {
        if !self.is_multilingual() {
            return match name {
                "en" => Ok(None),
                _ => Err(Error::invalid_param(format!(
                    "language = {name:.20?}, but this Whisper is English-only; use en, or load a multilingual model"
                ))),
            };
        }
        let found = self.languages.iter().find(|(own, _)| own == name);
        found.map(|(_, id)| Some(*id)).ok_or_else(|| {
            let known: Vec<_> = self.languages.iter().map(|(own, _)| own.as_str()).collect();
            Error::invalid_param(format!(
                "language = {name:.20?} is unknown; choose one of {}",
                known.join(", ")
            ))
        })
    }

    /// Returns the initial tokens of a transcript.
    pub fn beginning(&self, language: Option<u32>, times: bool) -> Vec<u32> {
        let mut tokens = vec![self.start];
        tokens.extend(language.into_iter().flat_map(|language| [language, self.transcribe]));
        tokens.extend((!times).then_some(self.no_times));
        tokens
    }

    /// Returns the text of tokens without timestamps and special tokens.
    pub fn text(&self, tokens: &[u32]) -> String {
        let words: Vec<u32> = tokens.iter().copied().filter(|token| *token < self.end).collect();
        self.tokenizer.text(&words)
    }
}

fn unspoken_signs(tokenizer: &Tokenizer) -> Result<Vec<u32>> {
    let mut unspoken = Vec::new();
    for text in [" -", " '"] {
        unspoken.extend(tokenizer.tokens(text)?.first());
    }
    for sign in SIGNS.split_whitespace().chain(NOTES) {
        for text in [sign.to_owned(), format!(" {sign}")] {
            let tokens = tokenizer.tokens(&text)?;
            if tokens.len() == 1 || NOTES.contains(&sign) {
                unspoken.extend(tokens.first());
            }
        }
    }
    Ok(unspoken)
}
