//! Byte pair encoding over bytes (Sennrich et al., ACL 2016; Radford et al. 2019), in the files of Hugging Face.

use std::collections::HashMap;

use opendr_engine::{Error, Result};
use serde::Deserialize;

/// A merge of two tokens, in either notation of the files.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub enum Merge {
    /// Both tokens, separated by a space.
    Text(String),
    /// The tokens.
    Pair(String, String),
}

impl Merge {
    fn pair(&self) -> Option<(&str, &str)> {
        match self {
            Self::Text(text) => text.split_once(' '),
            Self::Pair(left, right) => Some((left, right)),
        }
    }
}

/// Rank and resulting token of each pair of tokens that is merged.
#[derive(Debug)]
pub struct Merges(HashMap<(u32, u32), (usize, u32)>);

impl Merges {
    /// Looks up the tokens of merges, which are in the order of their rank.
    ///
    /// # Errors
    /// `Format` for a merge of other than two tokens of the vocabulary to a third.
    pub fn new(vocabulary: &HashMap<String, u32>, merges: &[Merge]) -> Result<Self> {
        let mut by_pair = HashMap::with_capacity(merges.len());
        for (order, merge) in merges.iter().enumerate() {
            let found = merge.pair().and_then(|(left, right)| {
                let id = |text: &str| vocabulary.get(text).copied();
                Some(((id(left)?, id(right)?), id(&format!("{left}{right}"))?))
            });
            let Some((pair, joined)) = found else {
                return Err(Error::format(format!(
                    "the tokenizer's merge {order} is not a merge of two tokens of its vocabulary"
                )));
            };
            by_pair.entry(pair).or_insert((order, joined));
        }
        Ok(Self(by_pair))
    }

    /// Returns the tokens of a word after all merges: of the pairs of neighbours, always that of the lowest rank is merged.
    pub fn joined(&self, mut tokens: Vec<u32>) -> Vec<u32> {
        loop {
            let pairs = tokens.windows(2).enumerate().filter_map(|(at, pair)| match pair {
                &[left, right] => self.0.get(&(left, right)).map(|(order, joined)| (*order, at, *joined)),
                _ => None,
            });
            let Some((_, at, joined)) = pairs.min() else { return tokens };
            tokens.splice(at..at + 2, [joined]);
        }
    }
}

/// Returns the byte that a character of a token stands for: printable bytes are themselves, the others are U+0100 onwards, in order.
pub fn byte_of(character: char) -> Option<u8> {
    match u8::try_from(character) {
        Ok(byte) => Some(byte).filter(|byte| stands_for_itself(*byte)),
        Err(_) => {
            let place = (character as usize).checked_sub(256)?;
            (0..=255).filter(|byte| !stands_for_itself(*byte)).nth(place)
        }
    }
}

/// Returns the character that stands for a byte in tokens.
pub fn character_of(byte: u8) -> char {
    if stands_for_itself(byte) {
        return char::from(byte);
    }
    let place = (0..byte).filter(|other| !stands_for_itself(*other)).count();
    char::from_u32(256 + place as u32).unwrap_or_default()
}

fn stands_for_itself(byte: u8) -> bool {
    matches!(byte, b'!'..=b'~' | 0xa1..=0xac | 0xae..=0xff)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_map_to_characters() {
        assert_eq!(byte_of('Ġ'), Some(b' '));
        assert_eq!(byte_of('Ċ'), Some(b'\n'));
        assert_eq!(byte_of('a'), Some(b'a'));
        assert_eq!([byte_of(' '), byte_of('\u{144}'), byte_of('€')], [None; 3]);
        assert!((0..=255).all(|byte| byte_of(character_of(byte)) == Some(byte)));
    }

    #[test]
    fn the_lowest_rank_is_merged_first() {
        let vocabulary: HashMap<String, u32> =
            ["a", "b", "c", "bc", "ab"].into_iter().map(String::from).zip(0..).collect();
        let merges = [Merge::Text("b c".into()), Merge::Pair("a".into(), "b".into())];
        let merges = Merges::new(&vocabulary, &merges).unwrap();
        assert_eq!(merges.joined(vec![0, 1, 2]), [0, 3]);
        assert_eq!(merges.joined(vec![0, 1, 0]), [4, 0]);
        for text in ["a", "a c", "a d", ""] {
            assert!(Merges::new(&vocabulary, &[Merge::Text(text.into())]).is_err(), "{text}");
        }
    }
}
