//! Changes of the cards of `models/`.

use std::fs;

use crate::shell::{Result, root};

/// Replaces the card of `LEARNER/VARIANT` by what `edit` returns of its text and the name of the variant.
pub fn edited_card(model: &str, edit: impl FnOnce(&str, &str) -> Option<String>) -> Result<()> {
    let (learner, variant) = model.split_once('/').ok_or_else(|| format!("{model} has no variant"))?;
    let path = root().join(format!("models/{learner}.toml"));
    let card = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let edited = edit(&card, variant)
        .ok_or_else(|| format!("{} has no licence of {variant} to write after", path.display()))?;
    fs::write(&path, edited).map_err(|error| format!("{}: {error}", path.display()))
}

/// Returns the card with `line` in place of the line of its variant that begins with `prefix`, or after that of the licence.
pub fn with_line(card: &str, variant: &str, prefix: &str, line: &str) -> Option<String> {
    let mut lines: Vec<&str> = card.lines().collect();
    let name = format!("name = {variant:?}");
    let begin = lines.iter().position(|line| *line == name)?;
    let length = lines[begin..].iter().position(|line| line.starts_with("[[")).unwrap_or(lines.len() - begin);
    let block = begin..begin + length;
    match lines[block.clone()].iter().position(|line| line.starts_with(prefix)) {
        Some(at) => lines[begin + at] = line,
        None => {
            let licence = lines[block].iter().position(|line| line.starts_with("licence = "))?;
            lines.insert(begin + licence + 1, line);
        }
    }
    Some(lines.join("\n") + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_written_into_the_block_of_its_variant() {
        let card = "[[variants]]\nname = \"a\"\nlicence = {}\n\n[[variants]]\nname = \"b\"\nlicence = {}\nspeed = {}\n";
        let with = with_line(card, "a", "speed = ", "speed = 1").unwrap();
        assert_eq!(with, card.replacen("licence = {}\n", "licence = {}\nspeed = 1\n", 1));
        assert_eq!(
            with_line(card, "b", "speed = ", "speed = 1").unwrap(),
            card.replace("speed = {}", "speed = 1")
        );
        assert_eq!(with_line(card, "c", "speed = ", "speed = 1"), None);
    }
}
