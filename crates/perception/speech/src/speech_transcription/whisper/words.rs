//! GPT-2's split of a text into pieces before byte pair encoding.

const ENDINGS: [&str; 7] = ["'s", "'t", "'re", "'ve", "'m", "'ll", "'d"];

/// Returns the pieces that GPT-2's pattern matches: endings such as `'ll`; letters, digits or other characters, each with one
/// preceding space; and white space, of which the last character belongs to the next piece.
pub fn words_of(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
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
    match character {
        _ if character.is_alphabetic() => Sign::Letter,
        _ if character.is_numeric() => Sign::Digit,
        _ if character.is_whitespace() => Sign::White,
        _ => Sign::Other,
    }
}

/// Returns the length of the first piece in bytes.
fn length(text: &str) -> usize {
    if let Some(ending) = ENDINGS.into_iter().find(|ending| text.starts_with(ending)) {
        return ending.len();
    }
    let body = text.strip_prefix(' ').filter(|rest| rest.starts_with(|next: char| !next.is_whitespace()));
    let body = body.unwrap_or(text);
    let Some(kind) = body.chars().next().map(sign) else { return 0 };
    let run: usize = body.chars().take_while(|character| sign(*character) == kind).map(char::len_utf8).sum();
    let whole = text.len() - body.len() + run;
    if kind != Sign::White || run == body.len() {
        return whole;
    }
    let last = body.get(..run).and_then(|white| white.chars().next_back()).map_or(0, char::len_utf8);
    if run > last { run - last } else { run }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected pieces computed with the pattern in Python's `regex`.
    #[test]
    fn pieces() {
        let pieces = |text| words_of(text).collect::<Vec<_>>();
        assert_eq!(pieces("I'll try, 12 times!"), ["I", "'ll", " try", ",", " 12", " times", "!"]);
        assert_eq!(pieces("a  b\n\nc "), ["a", " ", " b", "\n", "\n", "c", " "]);
        assert_eq!(pieces("  "), ["  "]);
        assert_eq!(pieces("x9'sé"), ["x", "9", "'s", "é"]);
        assert!(pieces("").is_empty());
    }
}
