use opendr_engine::Value;
use opendr_engine::target::{SpeechCommand, VoskTranscription, WhisperTranscription};

use super::*;

fn counted(pairs: &[(&str, &str)]) -> Transcription {
    let mut transcription = Transcription::default();
    for (reference, hypothesis) in pairs {
        transcription.add(reference, hypothesis).unwrap();
    }
    transcription
}

#[test]
fn rates_by_hand() {
    let report = counted(&[("the cat sat", "the cat sat down"), ("go left now", "go right")]).finish();
    let number = |key: &str| report.statistics.get(key).unwrap();
    assert_eq!(number("wer"), 3.0 / 6.0);
    assert_eq!(number("mer"), 3.0 / 7.0);
    assert_eq!(number("wip"), (4.0 / 6.0) * (4.0 / 6.0));
    assert_eq!(number("utterance_error_rate"), 1.0);
    assert_eq!((number("word_hits"), number("word_insertions")), (4.0, 1.0));
}

#[test]
fn empty_texts() {
    let rates = |reference, hypothesis| {
        let counts = *counted(&[(reference, hypothesis)]).words();
        (counts.error_rate(), counts.match_error_rate(), counts.information_preserved())
    };
    assert_eq!(rates("", ""), (0.0, 0.0, 1.0));
    assert_eq!(rates(" ", "two words"), (2.0, 1.0, 0.0));
    assert_eq!(rates("two words", ""), (1.0, 1.0, 0.0));
    assert_eq!(Transcription::default().finish().statistics.get("wer"), None);
}

#[test]
fn words_are_separated_as_by_jiwer() {
    assert_eq!(split_words("one two"), ["one", "two"]);
    assert_eq!(split_words("one\ttwo \tthree\n\nfour"), ["one\ttwo", "three", "four"]);
    assert_eq!(split_words(" one \u{a0} two "), ["one", "two"]);
    assert!(split_words("").is_empty());
}

#[test]
fn normalization() {
    let all = TranscriptionParams { lower_case: true, drop_punctuation: true, join_whitespace: true };
    assert_eq!(all.normalized(" It's\tGO,\n\u{201c}Émile\u{201d}! "), "its go émile");
    let none = TranscriptionParams::default();
    assert_eq!(none.normalized(" It's\tGO "), "It's\tGO");
    let punctuation = TranscriptionParams { drop_punctuation: true, ..none };
    assert_eq!(punctuation.normalized("a$b+c-d_e (f)\u{3002}"), "a$b+cde f");
}

#[test]
fn every_transcription_and_command_has_a_text() {
    let text = "stop".to_owned();
    let values = [
        Value::from(VoskTranscription { text: text.clone(), ..VoskTranscription::default() }),
        Value::from(WhisperTranscription { text, ..WhisperTranscription::default() }),
        Value::from(SpeechCommand::new("stop", 1.0)),
    ];
    for value in &values {
        assert_eq!(Transcription::ground_truth(value.into()).unwrap().text, "stop");
    }
    assert!(
        Transcription::prediction((&Value::from(opendr_engine::target::Category::default())).into())
            .is_none()
    );
}

#[test]
fn parts_merge_to_the_whole() {
    let mut first = counted(&[("a b", "a")]);
    first.merge(counted(&[("c", "c d")]));
    assert_eq!(first.finish(), counted(&[("c", "c d"), ("a b", "a")]).finish());
}

#[test]
fn long_texts_are_rejected() {
    let mut transcription = Transcription::default();
    assert!(transcription.add("a", &"b".repeat(MAX_CHARACTERS + 1)).is_err());
    assert_eq!(transcription.finish().statistics.get("utterances"), Some(0.0));
}
