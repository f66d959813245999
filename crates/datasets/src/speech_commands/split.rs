//! Assignment of clips to parts by their speaker.

use opendr_engine::{Error, Result};

/// Part of Speech Commands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpeechSplit {
    /// 80 % of the speakers.
    Training,
    /// 10 % of the speakers.
    Validation,
    /// 10 % of the speakers.
    Testing,
}

impl SpeechSplit {
    /// Returns the part `name`: `training`, `validation`, `testing`, or a common alias.
    ///
    /// # Errors
    /// `NotFound` for another name.
    pub fn from_name(name: &str) -> Result<Self> {
        match name {
            "training" | "train" => Ok(Self::Training),
            "validation" | "val" => Ok(Self::Validation),
            "testing" | "test" => Ok(Self::Testing),
            other => Err(Error::not_found(format!(
                "no part {other:.40?}; there are training, validation, testing"
            ))),
        }
    }
}

const PERCENT: f64 = 10.0;
const MAX_CLIPS_A_WORD: u64 = (1 << 27) - 1;

/// Returns the speaker of a clip from its file name: the text before `_nohash_`, without the word that precedes it
/// in the test files (`bird_653a48f5_nohash_0.wav`). Clips of noise, without a speaker, return their own name.
pub fn speaker_of_clip(file_name: &str) -> &str {
    match file_name.split_once("_nohash_") {
        Some((speaker, _)) => speaker.rsplit('_').next().unwrap_or(speaker),
        None => file_name,
    }
}

/// Returns the part of a clip from its file name. The SHA-1 of its [speaker](speaker_of_clip) decides, so that a
/// speaker stays in one part when the data set grows (`which_set` of the paper's code).
pub fn split_of_clip(file_name: &str) -> SpeechSplit {
    let [.., a, b, c, d] = sha1(speaker_of_clip(file_name).as_bytes());
    let last = u64::from(u32::from_be_bytes([a, b, c, d])) & MAX_CLIPS_A_WORD;
    match last as f64 * (100.0 / MAX_CLIPS_A_WORD as f64) {
        percent if percent < PERCENT => SpeechSplit::Validation,
        percent if percent < 2.0 * PERCENT => SpeechSplit::Testing,
        _ => SpeechSplit::Training,
    }
}

/// Computes SHA-1 (RFC 3174), which the rule of the data set uses; it is not for security.
fn sha1(message: &[u8]) -> [u8; 20] {
    let mut padded = message.to_vec();
    padded.push(0x80);
    padded.resize((padded.len() + 8).next_multiple_of(64) - 8, 0);
    padded.extend((message.len() as u64 * 8).to_be_bytes());
    let mut state: [u32; 5] = [0x6745_2301, 0xefcd_ab89, 0x98ba_dcfe, 0x1032_5476, 0xc3d2_e1f0];
    for block in padded.as_chunks::<64>().0 {
        let mut words = [0u32; 80];
        for (word, bytes) in words.iter_mut().zip(block.as_chunks::<4>().0) {
            *word = u32::from_be_bytes(*bytes);
        }
        for at in 16..80 {
            words[at] = (words[at - 3] ^ words[at - 8] ^ words[at - 14] ^ words[at - 16]).rotate_left(1);
        }
        let [mut a, mut b, mut c, mut d, mut e] = state;
        for (at, word) in words.iter().enumerate() {
            let (mixed, constant) = match at / 20 {
                0 => (b & c | !b & d, 0x5a82_7999),
                1 => (b ^ c ^ d, 0x6ed9_eba1),
                2 => (b & c | b & d | c & d, 0x8f1b_bcdc),
                _ => (b ^ c ^ d, 0xca62_c1d6),
            };
            let sum = a.rotate_left(5).wrapping_add(mixed).wrapping_add(e);
            let sum = sum.wrapping_add(*word).wrapping_add(constant);
            (a, b, c, d, e) = (sum, a, b.rotate_left(30), c, d);
        }
        for (total, part) in state.iter_mut().zip([a, b, c, d, e]) {
            *total = total.wrapping_add(part);
        }
    }
    let mut digest = [0; 20];
    for (bytes, word) in digest.as_chunks_mut::<4>().0.iter_mut().zip(state) {
        *bytes = word.to_be_bytes();
    }
    digest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vectors of RFC 3174.
    #[test]
    fn digests_are_sha1() {
        let hex = |message: &str| sha1(message.as_bytes()).map(|byte| format!("{byte:02x}")).concat();
        assert_eq!(hex("abc"), "a9993e364706816aba3e25717850c26c9cd0d89d");
        let long = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
        assert_eq!(hex(long), "84983e441c3bd26ebaae4aa1f95129e5e54670f1");
        assert_eq!(hex(""), "da39a3ee5e6b4b0d3255bfef95601890afd80709");
    }

    #[test]
    fn a_speaker_is_in_one_part() {
        assert_eq!(split_of_clip("0bac8a71_nohash_0.wav"), split_of_clip("0bac8a71_nohash_7.wav"));
        assert_eq!(split_of_clip("bird_0bac8a71_nohash_0.wav.wav"), split_of_clip("0bac8a71_nohash_0.wav"));
        assert_eq!(speaker_of_clip("1097.wav"), "1097.wav");
        assert!(SpeechSplit::from_name("other").is_err());
    }
}
