//! Tokens of Whisper's texts.

use std::collections::HashMap;

use opendr_engine::{Error, Result};
use opendr_perception_common::byte_pairs::{Merge, Merges, byte_of};
use serde::Deserialize;

use super::words::words_of;

/// Upper bound of token ids; far above those of any Whisper.
const MOST_TOKENS: u32 = 1 << 20;

/// Maximum length of an encoded text in bytes; a prompt of 223 tokens has about a thousand.
const LONGEST: usize = 1 << 16;

/// Vocabulary as bytes, and the merges.
pub struct Tokenizer {
    bytes: Vec<Vec<u8>>,
    of_byte: [Option<u32>; 256],
    merges: Merges,
    special: HashMap<String, u32>,
}

#[derive(Deserialize)]
struct TokenizerFile {
    #[serde(default)]
    added_tokens: Vec<AddedToken>,
    model: Model,
}

#[derive(Deserialize)]
struct AddedToken {
    id: u32,
    content: String,
}

#[derive(Deserialize)]
struct Model {
    vocab: HashMap<String, u32>,
    merges: Vec<Merge>,
}

impl Tokenizer {
    /// Parses Hugging Face's `tokenizer.json`.
    ///
    /// # Errors
    /// `Format` when the file is no tokenizer, or no byte-level one.
    pub fn from_json(json: &[u8]) -> Result<Self> {
        let TokenizerFile { added_tokens, model } = serde_json::from_slice(json)
            .map_err(|error| Error::format("tokenizer.json is damaged").with_source(error))?;
        let ids = model.vocab.values().copied().chain(added_tokens.iter().map(|token| token.id));
        let last = ids.max().filter(|id| *id < MOST_TOKENS).ok_or_else(|| {
            Error::format(format!("tokenizer.json has no tokens, or more than {MOST_TOKENS}"))
        })?;
        let mut bytes = vec![Vec::new(); last as usize + 1];
        let mut of_byte = [None; 256];
        for (text, id) in &model.vocab {
            // Special tokens may also be in the vocabulary; they are no text.
            let spelled: Option<Vec<u8>> = text.chars().map(byte_of).collect();
            if let Some(&[byte]) = spelled.as_deref() {
                of_byte[usize::from(byte)] = Some(*id);
            }
            if let Some(place) = bytes.get_mut(*id as usize) {
                *place = spelled.unwrap_or_default();
            }
        }
        let merges = Merges::new(&model.vocab, &model.merges)?;
        for token in &added_tokens {
            if let Some(place) = bytes.get_mut(token.id as usize) {
                place.clear();
            }
        }
        let special = added_tokens.into_iter().map(|token| (token.content, token.id)).collect();
        Ok(Self { bytes, of_byte, merges, special })
    }

    /// Returns the number of tokens, including special ones.
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Returns the id of a special token, e.g. `<|endoftext|>`.
    pub fn special(&self, spelling: &str) -> Option<u32> {
        self.special.get(spelling).copied()
    }

    /// Returns all special tokens.
    pub fn specials(&self) -> impl Iterator<Item = (&str, u32)> {
        self.special.iter().map(|(spelling, id)| (spelling.as_str(), *id))
    }

    /// Appends the bytes of a token; special tokens have none.
    pub fn extend(&self, bytes: &mut Vec<u8>, token: u32) {
        if let Some(own) = self.bytes.get(token as usize) {
            bytes.extend_from_slice(own);
        }
    }

    /// Returns the text of tokens; invalid UTF-8 becomes U+FFFD, special tokens are skipped.
    pub fn text(&self, tokens: &[u32]) -> String {
        let mut bytes = Vec::new();
        tokens.iter().for_each(|token| self.extend(&mut bytes, *token));
        String::from_utf8_lossy(&bytes).into_owned()
    }

    /// Returns the tokens of a text. Special tokens in it are encoded as text.
    ///
    /// # Errors
    /// `InvalidParam` for a text of more than 65,536 bytes, `Format` when the tokenizer lacks one of the 256 bytes.
    pub fn tokens(&self, text: &str) -> Result<Vec<u32>> {
        if text.len() > LONGEST {
            return Err(Error::invalid_param(format!(
                "the prompt or prefix has {} bytes; at most {LONGEST} are allowed",
                text.len()
            )));
        }
        let mut tokens = Vec::new();
        for word in words_of(text) {
            let ids: Option<Vec<u32>> = word.bytes().map(|byte| self.of_byte[usize::from(byte)]).collect();
            let ids =
                ids.ok_or_else(|| Error::format("tokenizer.json lacks a token for at least one byte"))?;
            tokens.extend(self.merges.joined(ids));
        }
        Ok(tokens)
    }
}

#[cfg(test)]
pub mod tests {
    use opendr_perception_common::byte_pairs::character_of;

    use super::*;

    /// Creates a vocabulary of the bytes, a few joins, and special tokens from 260 on.
    pub fn tiny(special: &[&str]) -> Tokenizer {
        let mut vocab: serde_json::Map<String, serde_json::Value> =
            (0..=255u8).map(|byte| (character_of(byte).to_string(), byte.into())).collect();
        for (id, text) in [(256, "he"), (257, "ll"), (258, "hell"), (259, "Ġhe")] {
            vocab.insert(text.to_owned(), id.into());
        }
        let special: Vec<_> = special
            .iter()
            .zip(260..)
            .map(|(content, id)| serde_json::json!({"id": id, "content": content}))
            .collect();
        let json = serde_json::json!({
            "added_tokens": special,
            "model": {"vocab": vocab, "merges": ["h e", ["l", "l"], "he ll", "Ġ he"]}
        });
        Tokenizer::from_json(json.to_string().as_bytes()).unwrap()
    }

    #[test]
    fn the_first_merge_is_applied_first() {
        let tokenizer = tiny(&["<|end|>"]);
        assert_eq!(tokenizer.tokens("hello he").unwrap(), [258, u32::from(b'o'), 259]);
        assert_eq!(tokenizer.text(&[258, u32::from(b'o'), 259, 260]), "hello he");
        let text = "naïve 5 µm\n\t'll don't";
        assert_eq!(tokenizer.text(&tokenizer.tokens(text).unwrap()), text);
        assert_eq!((tokenizer.len(), tokenizer.special("<|end|>")), (261, Some(260)));
        assert!(tokenizer.tokens(&"x".repeat(LONGEST + 1)).is_err());
    }

    #[test]
    fn damaged_files_are_refused() {
        for json in [
            "",
            "{}",
            r#"{"model": {"vocab": {}, "merges": []}}"#,
            r#"{"model": {"vocab": {"a": 4294967295}, "merges": []}}"#,
            r#"{"model": {"vocab": {"a": 0}, "merges": ["a b"]}}"#,
            r#"{"model": {"vocab": {"a": 0}, "merges": ["a"]}}"#,
        ] {
            assert!(Tokenizer::from_json(json.as_bytes()).is_err(), "{json}");
        }
    }
}
