//! Tests without weights. `crates/opendr/tests/whisper.rs` has those with weights.

use super::decoding::Decoded;
use super::rules::Rules;
use super::segments::{Part, cut};
use super::spectrogram::Spectrogram;
use super::tokenizer::tests::tiny;
use super::*;

const SPECIAL: [&str; 10] = [
    "<|endoftext|>",
    "<|startoftranscript|>",
    "<|en|>",
    "<|de|>",
    "<|translate|>",
    "<|transcribe|>",
    "<|startoflm|>",
    "<|startofprev|>",
    "<|nospeech|>",
    "<|notimestamps|>",
];
const END: u32 = 260;
const FIRST: u32 = 270;
const COUNT: usize = FIRST as usize + 1501;

fn vocabulary() -> Vocabulary {
    Vocabulary::new(tiny(&SPECIAL), COUNT).unwrap()
}

#[test]
fn languages_are_those_of_the_model() {
    let english = vocabulary();
    assert_eq!(english.language("en").unwrap(), None);
    assert!(english.language("de").is_err());
    assert_eq!(english.beginning(None, false), [261, 269]);
    let multilingual = Vocabulary::new(tiny(&SPECIAL), 51_865).unwrap();
    let german = multilingual.language("de").unwrap();
    assert_eq!(multilingual.beginning(german, true), [261, 263, 265]);
    assert!(multilingual.language("tlh").unwrap_err().to_string().contains("en, de"));
}

#[test]
fn other_tokenizers_are_refused() {
    assert!(Vocabulary::new(tiny(&SPECIAL[..9]), COUNT).is_err());
    assert!(Vocabulary::new(tiny(&SPECIAL), COUNT - 1).is_err());
}

/// Returns the tokens that the rules allow after `sampled` for equal logits, where the timestamps together are less likely than
/// a word.
fn allowed(sampled: &[u32]) -> Vec<u32> {
    let vocabulary = vocabulary();
    let rules = Rules {
        vocabulary: &vocabulary,
        suppress_blank: true,
        suppressed: &[7],
        times: true,
        latest_begin: Some(50),
    };
    let mut logits = vec![0.0; COUNT];
    logits[FIRST as usize..].fill(-20.0);
    rules.apply(&mut logits, sampled);
    (0..COUNT as u32).filter(|token| logits[*token as usize] > f32::NEG_INFINITY).collect()
}

#[test]
fn timestamps_come_in_pairs_and_never_decrease() {
    assert_eq!(allowed(&[]), (FIRST..=FIRST + 50).collect::<Vec<_>>());
    let after_begin = allowed(&[FIRST]);
    assert!(after_begin.contains(&104) && after_begin.contains(&END) && !after_begin.contains(&7));
    assert!(after_begin.iter().all(|token| *token < FIRST && *token != 269));
    let in_text = allowed(&[FIRST + 4, 104]);
    assert!(in_text.contains(&104) && !in_text.contains(&(FIRST + 4)) && in_text.contains(&(FIRST + 5)));
    let after_end = allowed(&[FIRST, 104, FIRST + 9]);
    assert!(
        after_end.iter().all(|token| *token == END || (END..FIRST).contains(token) || *token >= FIRST + 9)
    );
    assert!(after_end.contains(&(FIRST + 9)));
    assert!(allowed(&[FIRST, 104, FIRST + 9, FIRST + 9]).iter().all(|token| *token < FIRST));
}

#[test]
fn likely_timestamps_suppress_words() {
    let vocabulary = vocabulary();
    let rules = Rules {
        vocabulary: &vocabulary,
        suppress_blank: true,
        suppressed: &[],
        times: true,
        latest_begin: None,
    };
    let mut logits = vec![0.0; COUNT];
    rules.apply(&mut logits, &[FIRST, 104]);
    assert_eq!(logits[104], f32::NEG_INFINITY);
    assert_eq!(logits[FIRST as usize + 1], 0.0);
}

#[test]
fn windows_are_split_at_timestamps() {
    let vocabulary = vocabulary();
    let cut = |tokens: &[u32]| {
        let decoded = Decoded { tokens: tokens.to_vec(), ..Decoded::default() };
        cut(&decoded, &vocabulary, 2000)
    };
    let part = |start: f32, end: f32, tokens: &[u32]| Part { start, end, tokens: tokens.to_vec() };
    let [a, b, c, d] = [FIRST, FIRST + 100, FIRST + 150, FIRST + 200];
    // The last segment is unfinished: the next window begins with it.
    let (parts, frames) = cut(&[a, 1, b, b, 2, c, c, 3]);
    assert_eq!((parts, frames), (vec![part(0.0, 2.0, &[a, 1, b]), part(2.0, 3.0, &[b, 2, c])], 300));
    let (parts, frames) = cut(&[a, 1, b, b, 2, d]);
    assert_eq!((parts.len(), parts[1].end, frames), (2, 4.0, 2000));
    assert_eq!(cut(&[a, 1, c]), (vec![part(0.0, 3.0, &[a, 1, c])], 2000));
    assert_eq!(cut(&[1, 2]), (vec![part(0.0, 20.0, &[1, 2])], 2000));
    assert_eq!(cut(&[]), (vec![part(0.0, 20.0, &[])], 2000));
}

#[test]
fn spectrograms_have_complete_frames_and_are_padded_with_silence() {
    let maker = SpectrogramMaker::new(80).unwrap();
    let (mut spectrogram, mut window) = (Spectrogram::default(), Vec::new());
    let tone: Vec<f32> = (0..16_100).map(|at| (at as f32 * 0.3).sin()).collect();
    maker.run_into(&tone, &mut spectrogram);
    assert_eq!(spectrogram.frames, 100);
    maker.window_into(&spectrogram, 40, &mut window);
    assert_eq!(window.len(), 80 * 3000);
    assert!(window[59] != 0.0 && window[60..3000].iter().all(|band| *band == 0.0));
    let loudest = window.iter().copied().fold(f32::MIN, f32::max);
    assert!(window.iter().all(|band| *band == 0.0 || *band > loudest - 2.01));
    maker.run_into(&tone[..159], &mut spectrogram);
    assert_eq!(spectrogram.frames, 0);
}
