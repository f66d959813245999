//! `cargo xtask words`: finds phrases of `xtask/words.tsv` in documentation and messages, and prints the term to use.

use regex_lite::Regex;

use crate::inputs;
use crate::lexer::Language;
use crate::passages::{self, Passage};
use crate::shell::Result;

/// The list of phrases, and the term to use for each.
const LIST: &str = "xtask/words.tsv";

/// Pages that quote older words.
const LEFT_OUT: [&str; 1] = ["docs/glossary.md"];

/// Checks all files; fails if one has a phrase of the list.
pub fn run() -> Result<()> {
    let phrases = Phrases::parse(&inputs::text(LIST)?)?;
    let mut count = 0;
    for file in inputs::files()?.iter().filter(|file| is_checked(file)) {
        for passage in passages_of(file, &inputs::text(file)?) {
            for (line, phrase, term) in phrases.find(&passage) {
                println!("{file}:{line}: \"{phrase}\": use \"{term}\"");
                count += 1;
            }
        }
    }
    match count {
        0 => Ok(()),
        count => Err(format!(
            "{count} phrases of {LIST}; write the term that is printed with each (docs/glossary.md), or make the pattern of a \
             phrase that is right more specific"
        )),
    }
}

/// Returns whether a file of the repository is checked, or decides what is found.
pub fn is_input(file: &str) -> bool {
    is_checked(file) || file == LIST
}

fn is_checked(file: &str) -> bool {
    (language(file).is_some() || file.ends_with(".md")) && !LEFT_OUT.contains(&file)
}

fn language(file: &str) -> Option<Language> {
    match file.rsplit_once('.')?.1 {
        "rs" => Some(Language::Rust),
        "h" => Some(Language::C),
        "py" | "pyi" => Some(Language::Python),
        _ => None,
    }
}

fn passages_of(file: &str, text: &str) -> Vec<Passage> {
    match language(file) {
        Some(language) => passages::of_source(text, language),
        None if file == "CHANGELOG.md" => passages::of_page(unreleased(text)),
        None => passages::of_page(text),
    }
}

/// Returns the changelog up to the first release: entries of releases are not rewritten.
fn unreleased(changelog: &str) -> &str {
    let mut sections = changelog.match_indices("\n## ");
    sections.next();
    sections.next().map_or(changelog, |(end, _)| &changelog[..end])
}

/// The phrases of a list.
struct Phrases {
    /// Any of them.
    any: Regex,
    /// Each of them, and the term to use.
    each: Vec<(Regex, String)>,
}

impl Phrases {
    /// Reads lines of a regular expression, a tab and a term; lines that begin with `#` are comments.
    fn parse(list: &str) -> Result<Self> {
        let mut patterns = Vec::new();
        let mut each = Vec::new();
        for (number, line) in (1..).zip(list.lines()) {
            if line.trim().is_empty() || line.starts_with('#') {
                continue;
            }
            let (pattern, term) = line
                .split_once('\t')
                .filter(|(pattern, term)| !pattern.trim().is_empty() && !term.trim().is_empty())
                .ok_or_else(|| format!("{LIST}:{number}: write a phrase, a tab and the term to use"))?;
            let phrase = Regex::new(&format!("(?i)^(?:{pattern})$"))
                .map_err(|error| format!("{LIST}:{number}: {pattern:?} is no regular expression: {error}"))?;
            patterns.push(format!("(?:{pattern})"));
            each.push((phrase, term.trim().to_owned()));
        }
        let any = if patterns.is_empty() { "[^\\s\\S]".to_owned() } else { patterns.join("|") };
        let any = Regex::new(&format!("(?i)\\b(?:{any})\\b")).map_err(|error| format!("{LIST}: {error}"))?;
        Ok(Self { any, each })
    }

    /// Returns the phrases in a passage outside of code, each with its line and the term to use.
    fn find<'a>(&'a self, passage: &'a Passage) -> Vec<(usize, &'a str, &'a str)> {
        let matches: Vec<_> = self.any.find_iter(passage.text()).collect();
        if matches.is_empty() {
            return Vec::new();
        }
        let code = passage.code();
        let prose =
            matches.into_iter().filter(|found| !code.iter().any(|span| span.contains(&found.start())));
        prose
            .map(|found| {
                let phrase = self.each.iter().find(|(phrase, _)| phrase.is_match(found.as_str()));
                let term = phrase.map_or("a term of docs/glossary.md", |(_, term)| term);
                (passage.line(found.start()), found.as_str(), term)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORDS: &str = "# comment\n\nred apples?\tfruit\nplum|quince\tstone fruit\n";

    fn found(file: &str, text: &str) -> Vec<(usize, String, String)> {
        let phrases = Phrases::parse(WORDS).unwrap();
        let passages = passages_of(file, text);
        let found = passages.iter().flat_map(|passage| phrases.find(passage));
        found.map(|(line, phrase, term)| (line, phrase.to_owned(), term.to_owned())).collect()
    }

    fn lines(file: &str, text: &str) -> Vec<usize> {
        found(file, text).into_iter().map(|(line, ..)| line).collect()
    }

    #[test]
    fn phrases_are_found_over_line_ends_and_in_any_case() {
        let found = found("a.rs", "/// Some red\n/// apples and a Plum.\nfn plum() {}\n");
        let [first, second] = &found[..] else { panic!("{found:?}") };
        assert_eq!(first, &(1, "red apples".to_owned(), "fruit".to_owned()));
        assert_eq!(second, &(2, "Plum".to_owned(), "stone fruit".to_owned()));
    }

    #[test]
    fn parts_of_words_and_code_are_no_phrases() {
        assert!(
            found("a.rs", "/// Plums, `plum`, infrared apples.\nerror(\"no {plum} here\", \"plum\")")
                .is_empty()
        );
    }

    #[test]
    fn every_kind_of_file_is_checked() {
        assert_eq!(lines("a.rs", "error(\n\"no plum\")"), [2]);
        assert_eq!(lines("a.py", "'''A\nplum.'''\n# quince\nx = 'plum'\n"), [2, 3]);
        assert_eq!(lines("a.pyi", "\"\"\"A plum.\"\"\""), [1]);
        assert_eq!(lines("a.h", "/** A\n * plum. */"), [2]);
        assert_eq!(lines("a.md", "A\n\nplum"), [3]);
        assert!(is_checked("docs/python.md") && is_input(LIST));
        assert!(!is_checked("docs/glossary.md") && !is_checked(LIST) && !is_checked("a.png"));
    }

    #[test]
    fn releases_of_the_changelog_are_not_checked() {
        let changelog = "# Changelog\n\n## Unreleased\n\n- plum\n\n## 0.1.0\n\n- plum\n";
        assert_eq!(lines("CHANGELOG.md", changelog), [5]);
        assert_eq!(lines("CHANGELOG.md", "# Changelog\n\n## Unreleased\n\n- plum\n"), [5]);
    }

    #[test]
    fn invalid_lists_are_errors() {
        for (list, line) in [("plum\n", 1), ("#\nplum\t\n", 2), ("plum\tfruit\n(\tfruit", 2)] {
            let error = Phrases::parse(list).err().unwrap();
            assert!(error.starts_with(&format!("xtask/words.tsv:{line}: ")), "{error}");
        }
        assert!(Phrases::parse("").unwrap().find(&passages::of_page("plum")[0]).is_empty());
    }
}
