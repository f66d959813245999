//! Functions of one data or target type each, over those of any value.

use opendr::ValueType;
use opendr_c::ARRAYS;

const FUNCTIONS: &str = include_str!("value_functions.h");

/// Returns `opendr_bounding_box_3d_list` of `BoundingBox3DList`.
pub fn c_name(kind: ValueType) -> String {
    let mut name = "opendr".to_owned();
    let letters: Vec<char> = kind.name().chars().collect();
    for (index, letter) in letters.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| letters[before]);
        let is_word = letter.is_ascii_digit()
            || letter.is_ascii_uppercase() && !before.is_some_and(|c| c.is_ascii_digit());
        if is_word {
            name.push('_');
        }
        name.push(letter.to_ascii_lowercase());
    }
    name
}

/// Returns the macros, and one line for each type.
pub fn render() -> String {
    let mut text = FUNCTIONS.to_owned();
    for kind in ValueType::ALL {
        text += &format!("OPENDR_VALUE_FUNCTIONS({})\n", c_name(*kind));
    }
    text.push('\n');
    for kind in ValueType::ALL.iter().filter(|kind| kind.is_target()) {
        text += &format!("OPENDR_TARGET_FUNCTIONS({}, \"{}\")\n", c_name(*kind), kind.name());
    }
    text.push('\n');
    for (kind, axes) in ARRAYS {
        let (name, count) = (c_name(kind), axes.len());
        text += &format!("/* shape: {} */\n", axes.join(", "));
        text += &format!("OPENDR_ARRAY_FUNCTIONS({name}, \"{}\", {count})\n", kind.name());
    }
    text
}

#[test]
fn names_are_words() {
    let names = [ValueType::BoundingBox3DList, ValueType::Image, ValueType::VoskTranscription].map(c_name);
    assert_eq!(names, ["opendr_bounding_box_3d_list", "opendr_image", "opendr_vosk_transcription"]);
}
