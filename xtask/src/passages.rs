//! Passages of prose in source files and pages: comments, string literals, paragraphs.

use std::ops::Range;

use crate::lexer::{self, Kind, Language, Token};

/// Prose on one or several lines: its words with one space between them, so that phrases continue over line ends.
#[derive(Debug, Default, PartialEq)]
pub struct Passage {
    text: String,
    /// Offset in `text` where each source line begins, and its number.
    lines: Vec<(usize, usize)>,
}

impl Passage {
    /// Returns the text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the source line of a byte of the text.
    pub fn line(&self, offset: usize) -> usize {
        let next = self.lines.partition_point(|(begin, _)| *begin <= offset);
        self.lines.get(next.saturating_sub(1)).map_or(0, |(_, line)| *line)
    }

    /// Returns the parts of the text that are code: spans between backticks, and fields of format strings between braces.
    pub fn code(&self) -> Vec<Range<usize>> {
        let mut spans = Vec::new();
        let mut at = 0;
        while let Some(found) = self.text[at..].find(['`', '{']) {
            let begin = at + found;
            let close = if self.text[begin..].starts_with('`') { '`' } else { '}' };
            let Some(length) = self.text[begin + 1..].find(close) else { break };
            at = begin + length + 2;
            spans.push(begin..at);
        }
        spans
    }

    fn push(&mut self, line: usize, text: &str) {
        for word in text.split_whitespace() {
            if !self.text.is_empty() {
                self.text.push(' ');
            }
            if self.lines.last().is_none_or(|(_, last)| *last != line) {
                self.lines.push((self.text.len(), line));
            }
            self.text.push_str(word);
        }
    }
}

/// Returns the comments and string literals of a source file. A literal of one word is a name, not prose, and is left out.
pub fn of_source(source: &str, language: Language) -> Vec<Passage> {
    let mut passages = Vec::new();
    let mut previous: Option<Token> = None;
    for token in lexer::tokens(source, language) {
        match token.kind {
            Kind::Comment => {
                let continues =
                    previous.is_some_and(|last| last.kind == Kind::Comment && last.line + 1 == token.line);
                let lines = (token.line..).zip(token.text.lines());
                paragraphs(lines.map(|(number, line)| (number, of_comment(line))), continues, &mut passages);
            }
            Kind::Literal if is_prose(token.text) => {
                let text = unescaped(token.text);
                paragraphs((token.line..).zip(text.lines()), false, &mut passages);
            }
            _ => (),
        }
        previous = Some(token);
    }
    passages.retain(|passage| !passage.text.is_empty());
    passages
}

/// Returns the paragraphs of a page.
pub fn of_page(source: &str) -> Vec<Passage> {
    let mut passages = Vec::new();
    paragraphs((1..).zip(source.lines()), false, &mut passages);
    passages.retain(|passage| !passage.text.is_empty());
    passages
}

/// Appends lines to the last passage if it `continues`, else to a new one. An empty line or the fence of a code block ends a passage.
fn paragraphs<'a>(
    lines: impl IntoIterator<Item = (usize, &'a str)>,
    continues: bool,
    passages: &mut Vec<Passage>,
) {
    if !continues {
        passages.push(Passage::default());
    }
    for (number, line) in lines {
        let line = line.trim();
        match passages.last_mut() {
            Some(passage) if !line.is_empty() && !line.starts_with("```") => passage.push(number, line),
            _ => passages.push(Passage::default()),
        }
    }
}

/// Returns a line of a comment without the comment's delimiters.
fn of_comment(line: &str) -> &str {
    line.trim().trim_start_matches(['/', '*', '!', '#']).trim_end_matches(['/', '*'])
}

fn is_prose(literal: &str) -> bool {
    literal.trim_matches(['"', '\'']).trim().contains(char::is_whitespace)
}

/// Returns the content of a literal with a space for each escaped character.
fn unescaped(literal: &str) -> String {
    let mut letters = literal.trim_matches(['"', '\'']).chars();
    let mut text = String::with_capacity(literal.len());
    while let Some(letter) = letters.next() {
        match letter {
            '\\' => match letters.next() {
                Some('\n') => text.push('\n'),
                _ => text.push(' '),
            },
            letter => text.push(letter),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(passages: &[Passage]) -> Vec<&str> {
        passages.iter().map(Passage::text).collect()
    }

    #[test]
    fn lines_of_a_comment_are_one_passage() {
        let source =
            "/// Returns the\n/// box.\n///\n/// # Errors\nfn f() {} // one\n// two\n\n/* three\n * four */";
        let passages = of_source(source, Language::Rust);
        assert_eq!(texts(&passages), ["Returns the box.", "# Errors", "one two", "three four"]);
        let line = |passage: usize, word: &str| {
            passages[passage].line(texts(&passages)[passage].find(word).unwrap())
        };
        assert_eq!(
            [line(0, "the"), line(0, "box"), line(1, "Errors"), line(2, "two"), line(3, "four")],
            [1, 2, 4, 6, 9]
        );
    }

    #[test]
    fn literals_of_one_word_are_left_out() {
        let source = "f(\"name\", \"no \\\"file\\\"\\nof \\\n    that {name}\", r#\"a b\"#)";
        assert_eq!(texts(&of_source(source, Language::Rust)), ["no file of that {name}", "r#\"a b\"#"]);
    }

    #[test]
    fn docstrings_and_comments_of_python_are_passages() {
        let source = "def f():\n    '''Returns\n    a box.\n\n    More.'''\n    return x  #: a\n";
        assert_eq!(texts(&of_source(source, Language::Python)), ["Returns a box.", "More.", ": a"]);
    }

    #[test]
    fn paragraphs_of_a_page_are_passages() {
        let passages = of_page("# Title\n\none\ntwo `three\nfour` {five}\n```\ncode\n```\nsix `open");
        assert_eq!(texts(&passages), ["# Title", "one two `three four` {five}", "code", "six `open"]);
        let code: Vec<_> = passages[1].code().into_iter().map(|span| &passages[1].text()[span]).collect();
        assert_eq!(code, ["`three four`", "{five}"]);
        assert!(passages[3].code().is_empty());
    }
}
