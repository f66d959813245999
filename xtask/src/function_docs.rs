//! The documentation of public functions begins with a verb in the third person ("Returns", "Creates"), as the standard library's does.

use crate::inputs;
use crate::shell::Result;

/// Beginnings without a verb: functions that differ from another one by a detail.
const REFERENCES: [&str; 2] = ["As [", "Same as ["];

/// Checks all Rust files; fails if the documentation of a public function begins otherwise.
pub fn check() -> Result<()> {
    let mut count = 0;
    for file in inputs::files()?.iter().filter(|file| file.ends_with(".rs")) {
        for (line, sentence) in unverbal(&inputs::text(file)?) {
            println!(
                "{file}:{line}: \"{sentence}\": begin with a verb in the third person: \"Returns ...\", \"Creates ...\""
            );
            count += 1;
        }
    }
    match count {
        0 => Ok(()),
        count => Err(format!("the documentation of {count} public functions does not begin with a verb")),
    }
}

/// Returns line and first line of the documentation of each public function that does not begin with a verb.
fn unverbal(source: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let mut documentation = None;
    for (at, line) in source.lines().enumerate() {
        let line = line.trim();
        if let Some(text) = line.strip_prefix("/// ") {
            documentation.get_or_insert((at + 1, text));
        } else if is_public_function(line) {
            found.extend(documentation.take().filter(|(_, text)| !begins_well(text)));
        } else if !line.starts_with("///") && !line.starts_with("#[") {
            documentation = None;
        }
    }
    found
}

fn is_public_function(line: &str) -> bool {
    let modifiers = ["const ", "unsafe ", "async "];
    let Some(mut rest) = line.strip_prefix("pub ") else { return false };
    while let Some(after) = modifiers.iter().find_map(|modifier| rest.strip_prefix(modifier)) {
        rest = after;
    }
    rest.starts_with("fn ")
}

fn begins_well(text: &str) -> bool {
    let word = text.split_whitespace().next().unwrap_or_default();
    let is_verb = word.starts_with(|letter: char| letter.is_ascii_uppercase())
        && word.ends_with('s')
        && word.chars().skip(1).all(|letter| letter.is_ascii_lowercase());
    REFERENCES.iter().any(|reference| text.starts_with(reference)) || (is_verb && word != "As")
}

#[cfg(test)]
mod tests {
    use super::unverbal;

    #[test]
    fn nouns_are_found_and_verbs_are_not() {
        let source = [
            "/// Number of rows.",
            "///",
            "/// More.",
            "#[must_use]",
            "pub const fn rows() {}",
            "/// Returns the rows.",
            "pub fn kept() {}",
            "/// As [`kept`], twice.",
            "pub fn twice() {}",
            "/// Rows of a table.",
            "pub struct Rows;",
            "/// A private one.",
            "fn private() {}",
        ]
        .join("\n");
        assert_eq!(unverbal(&source), [(1, "Number of rows.")]);
    }
}
