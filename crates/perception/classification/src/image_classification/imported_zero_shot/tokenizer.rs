//! CLIP's tokenizer: byte pair encoding of lower-case words, whose last token ends in `</w>`.

use std::collections::HashMap;

use icu_normalizer::ComposingNormalizerBorrowed;
use opendr_engine::{Error, Result};
use opendr_perception_common::byte_pairs::{Merge, Merges, character_of};
use serde::Deserialize;
use serde_json::Value;

use super::words::words_of;

/// Maximum length of a text, in bytes; its first 75 tokens are used.
const MAX_BYTES: usize = 4096;
/// What the last token of a word ends in.
const END_OF_WORD: &str = "</w>";
const START: &str = "<|startoftext|>";
const END: &str = "<|endoftext|>";

/// A tokenizer.
#[derive(Debug)]
pub struct ClipTokenizer {
    /// Token of each byte within a word.
    inner: [u32; 256],
    /// Token of each byte at the end of a word.
    last: [u32; 256],
    merges: Merges,
    start: u32,
    /// The token that ends a text.
    pub end: u32,
}

/// Hugging Face's `tokenizer.json`.
#[derive(Deserialize)]
struct TokenizerFile {
    #[serde(default)]
    added_tokens: Vec<AddedToken>,
    model: Value,
}

#[derive(Deserialize)]
struct AddedToken {
    id: u32,
    content: String,
}

#[derive(Deserialize)]
struct BytePairs {
    #[serde(default)]
    end_of_word_suffix: Option<String>,
    vocab: HashMap<String, u32>,
    merges: Vec<Merge>,
}

impl ClipTokenizer {
    /// Parses Hugging Face's `tokenizer.json`.
    ///
    /// # Errors
    /// `Format` for a damaged file, `Unsupported` for a tokenizer of another kind.
    pub fn from_json(json: &[u8]) -> Result<Self> {
        let damaged = |error| Error::format("tokenizer.json is damaged").with_source(error);
        let TokenizerFile { added_tokens, model } = serde_json::from_slice(json).map_err(damaged)?;
        let kind = model.get("type").and_then(Value::as_str).unwrap_or("BPE");
        if kind != "BPE" {
            return Err(Error::unsupported(format!(
                "tokenizer.json is of the kind {kind:.20?}, as those of SigLIP (Unigram) and Chinese CLIP (WordPiece); CLIP's is a BPE"
            )));
        }
        let BytePairs { end_of_word_suffix, mut vocab, merges } =
            serde_json::from_value(model).map_err(damaged)?;
        if end_of_word_suffix.as_deref() != Some(END_OF_WORD) {
            return Err(Error::unsupported(format!(
                "tokenizer.json is not CLIP's: its words do not end in {END_OF_WORD} (end_of_word_suffix)"
            )));
        }
        vocab.extend(added_tokens.into_iter().map(|token| (token.content, token.id)));
        Self::new(&vocab, &merges)
    }

    /// Parses `vocab.json` and `merges.txt`.
    ///
    /// # Errors
    /// As [`ClipTokenizer::from_json`].
    pub fn from_vocabulary(vocabulary: &[u8], merges: &[u8]) -> Result<Self> {
        let vocabulary: HashMap<String, u32> = serde_json::from_slice(vocabulary)
            .map_err(|error| Error::format("vocab.json is damaged").with_source(error))?;
        let merges = std::str::from_utf8(merges)
            .map_err(|error| Error::format("merges.txt is not UTF-8").with_source(error))?;
        let is_merge = |line: &&str| !line.is_empty() && !line.starts_with("#version");
        let merges: Vec<Merge> =
            merges.lines().map(str::trim_end).filter(is_merge).map(|line| Merge::Text(line.into())).collect();
        Self::new(&vocabulary, &merges)
    }

    fn new(vocabulary: &HashMap<String, u32>, merges: &[Merge]) -> Result<Self> {
        let token = |text: &str| {
            let missing =
                || Error::unsupported(format!("the vocabulary has no token {text:?}, so it is not CLIP's"));
            vocabulary.get(text).copied().ok_or_else(missing)
        };
        let bytes = |suffix: &str| -> Result<[u32; 256]> {
            let mut tokens = [0; 256];
            for (byte, place) in (0..=255).zip(&mut tokens) {
                *place = token(&format!("{}{suffix}", character_of(byte)))?;
            }
            Ok(tokens)
        };
        Ok(Self {
            inner: bytes("")?,
            last: bytes(END_OF_WORD)?,
            merges: Merges::new(vocabulary, merges)?,
            start: token(START)?,
            end: token(END)?,
        })
    }

    /// Returns the tokens of a text, with those of its start and its end: at most `length`.
    ///
    /// # Errors
    /// `InvalidParam` for a text of more than 4096 bytes, or with a special token in it.
    pub fn tokens(&self, text: &str, length: usize) -> Result<Vec<u32>> {
        let text = normalised(text);
        if text.len() > MAX_BYTES {
            return Err(Error::invalid_param(format!(
                "the text {text:.20?}... has {} bytes; at most {MAX_BYTES} are allowed",
                text.len()
            )));
        }
        if let Some(special) = [START, END].into_iter().find(|special| text.contains(special)) {
            return Err(Error::invalid_param(format!(
                "the text {text:.60?} contains the special token {special}; remove it"
            )));
        }
        let mut tokens = vec![self.start];
        for word in words_of(&text) {
            let Some((last, inner)) = word.as_bytes().split_last() else { continue };
            let mut symbols: Vec<u32> = inner.iter().map(|byte| self.inner[usize::from(*byte)]).collect();
            symbols.push(self.last[usize::from(*last)]);
            tokens.extend(self.merges.joined(symbols));
        }
        tokens.truncate(length.saturating_sub(1));
        tokens.push(self.end);
        Ok(tokens)
    }
}

/// Returns a text with composed accents, in lower case, with a space for each run of white space.
fn normalised(text: &str) -> String {
    let composed = ComposingNormalizerBorrowed::new_nfc().normalize(text);
    let words: Vec<&str> = composed.split(char::is_whitespace).filter(|word| !word.is_empty()).collect();
    words.join(" ").chars().flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
pub mod tests {
    use std::path::Path;

    use opendr_engine::Random;
    use opendr_engine::model::Model;

    use super::*;

    /// Expected tokens of transformers' CLIPTokenizer (`tests/extended/exported_clip_fixtures.py`).
    #[test]
    fn tokens_are_those_of_transformers() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/imported");
        let file = |name: &str, member: &str| Model::open(folder.join(name)).unwrap().file(member).unwrap();
        let json = ClipTokenizer::from_json(&file("clip.zip", "tokenizer.json")).unwrap();
        let parts = ["vocab.json", "merges.txt"].map(|member| file("clip_parts.zip", member));
        let parts = ClipTokenizer::from_vocabulary(&parts[0], &parts[1]).unwrap();
        let expected = std::fs::read(folder.join("clip_tokens.json")).unwrap();
        let expected: Value = serde_json::from_slice(&expected).unwrap();
        let texts: Vec<String> = serde_json::from_value(expected["texts"].clone()).unwrap();
        let wanted: Vec<Vec<u32>> = serde_json::from_value(expected["tokens"].clone()).unwrap();
        assert_eq!(texts.len(), wanted.len());
        for (text, wanted) in texts.iter().zip(wanted) {
            assert_eq!(json.tokens(text, 77).unwrap(), wanted, "{text:?}");
            assert_eq!(parts.tokens(text, 77).unwrap(), wanted, "{text:?}");
        }
    }

    #[test]
    fn mutations_never_panic() {
        let (json, mut random) = (tiny_json().into_bytes(), Random::new(1));
        let mut read = 0;
        for _ in 0..2000 {
            let mut json = json.clone();
            for _ in 0..=random.below(3) {
                let at = random.below(json.len());
                match random.below(3) {
                    0 => json[at] = random.below(256) as u8,
                    1 => _ = json.remove(at),
                    _ => json.insert(at, json[random.below(json.len())]),
                }
            }
            if let Ok(tokenizer) = ClipTokenizer::from_json(&json) {
                read += 1;
                tokenizer.tokens("A cat's café, 12 µm!", 77).ok();
            }
        }
        assert!((1..2000).contains(&read));
    }

    /// Creates the JSON of a tokenizer of the bytes and two merges.
    pub fn tiny_json() -> String {
        let bytes = (0..=255).map(|byte| character_of(byte).to_string());
        let ends = (0..=255).map(|byte| format!("{}{END_OF_WORD}", character_of(byte)));
        let others = ["at</w>", "cat</w>", START, END].map(String::from);
        let vocabulary: HashMap<String, u32> = bytes.chain(ends).chain(others).zip(0..).collect();
        let model = serde_json::json!({
            "type": "BPE", "end_of_word_suffix": END_OF_WORD, "vocab": vocabulary, "merges": [["a", "t</w>"], "c at</w>"],
        });
        serde_json::json!({ "model": model }).to_string()
    }

    #[test]
    fn words_are_lower_case_and_end() {
        let tokenizer = ClipTokenizer::from_json(tiny_json().as_bytes()).unwrap();
        let byte = |letter: char| tokenizer.inner[letter as usize];
        let last = |letter: char| tokenizer.last[letter as usize];
        assert_eq!(tokenizer.tokens(" CAT  ", 77).unwrap(), [514, 513, 515]);
        let wanted = [514, byte('c'), byte('a'), byte('t'), last('s'), 512, 515];
        assert_eq!(tokenizer.tokens("cats\nat", 77).unwrap(), wanted);
        assert_eq!(tokenizer.tokens("cats at", 4).unwrap(), [514, byte('c'), byte('a'), 515]);
        assert_eq!(tokenizer.tokens("", 77).unwrap(), [514, 515]);
        for text in ["a <|EndOfText|>".to_owned(), "x".repeat(MAX_BYTES + 1)] {
            assert_eq!(
                tokenizer.tokens(&text, 77).unwrap_err().kind(),
                opendr_engine::ErrorKind::InvalidParam
            );
        }
    }

    #[test]
    fn other_tokenizers_are_refused() {
        for json in [
            "",
            "{}",
            r#"{"model": {"type": "Unigram", "vocab": [["a", 0.0]]}}"#,
            r#"{"model": {"type": "BPE", "vocab": {"a": 0}, "merges": []}}"#,
            r#"{"model": {"end_of_word_suffix": "</w>", "vocab": {"a": 0}, "merges": []}}"#,
            r#"{"model": {"end_of_word_suffix": "</w>", "vocab": {"a": -1}, "merges": []}}"#,
        ] {
            assert!(ClipTokenizer::from_json(json.as_bytes()).is_err(), "{json}");
        }
        assert!(ClipTokenizer::from_json(tiny_json().replace("c at</w>", "c at").as_bytes()).is_err());
        assert!(ClipTokenizer::from_vocabulary(b"{\"a\": 0}", b"#version: 0.2\n").is_err());
        assert!(ClipTokenizer::from_vocabulary(b"{}", b"\xff").is_err());
    }
}
