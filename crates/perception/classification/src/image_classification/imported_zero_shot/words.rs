//! CLIP's split of a text into words before byte pair encoding.

use icu_properties::CodePointMapData;
use icu_properties::props::{GeneralCategory, GeneralCategoryGroup};

const ENDINGS: [&str; 7] = ["'s", "'t", "'re", "'ve", "'m", "'ll", "'d"];

/// Returns the words that CLIP's pattern matches: endings such as `'ll`, runs of letters, single digits, and runs of other characters but
/// white space.
pub fn words_of(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        rest = rest.trim_start();
        let (word, after) = rest.split_at_checked(length(rest)).filter(|(word, _)| !word.is_empty())?;
        rest = after;
        Some(word)
    })
}

#[derive(PartialEq)]
enum Sign {
    Letter,
    Digit,
    White,
    Other,
}

fn sign(character: char) -> Sign {
    let category = CodePointMapData::<GeneralCategory>::new().get(character);
    match character {
        _ if GeneralCategoryGroup::Letter.contains(category) => Sign::Letter,
        _ if GeneralCategoryGroup::Number.contains(category) => Sign::Digit,
        _ if character.is_whitespace() => Sign::White,
        _ => Sign::Other,
    }
}

/// Returns the length of the first word in bytes.
fn length(text: &str) -> usize {
    if let Some(ending) = ENDINGS.into_iter().find(|ending| text.starts_with(ending)) {
        return ending.len();
    }
    let Some(first) = text.chars().next() else { return 0 };
    match sign(first) {
        Sign::Digit => first.len_utf8(),
        kind => text.chars().take_while(|character| sign(*character) == kind).map(char::len_utf8).sum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected words computed with the pattern in Python's `regex`.
    #[test]
    fn words() {
        let words = |text| words_of(text).collect::<Vec<_>>();
        assert_eq!(words("i'll try, 12 times!"), ["i", "'ll", "try", ",", "1", "2", "times", "!"]);
        assert_eq!(words("!!'s 'sound"), ["!!'", "s", "'s", "ound"]);
        assert_eq!(words(" x\u{903}\u{2167}\u{24b6}é "), ["x", "\u{903}", "\u{2167}", "\u{24b6}", "é"]);
        assert!(words(" ").is_empty());
    }
}
