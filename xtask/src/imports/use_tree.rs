//! Trees of `use` declarations in Rust.

use crate::lexer::{Kind, Token};

/// One name of a `use` declaration.
pub struct Use {
    pub path: Path,
    /// Name in the module; `*` if it imports all names.
    pub name: String,
    pub is_public: bool,
}

/// A path of names.
#[derive(Clone)]
pub struct Path {
    pub segments: Vec<String>,
    pub line: usize,
}

/// Returns the names of a `use` declaration, whose tokens after the keyword begin `tokens`.
pub fn names_of_use(tokens: &[Token], is_public: bool) -> Vec<Use> {
    let mut reader = UseReader { tokens, at: 0, is_public, found: Vec::new() };
    reader.read(&[]);
    reader.found
}

/// Reader of the tree of a `use` declaration.
struct UseReader<'a> {
    tokens: &'a [Token<'a>],
    at: usize,
    is_public: bool,
    found: Vec<Use>,
}

impl UseReader<'_> {
    fn next_is(&self, symbol: &str) -> bool {
        self.tokens.get(self.at).is_some_and(|token| token.is(symbol))
    }

    /// Reads the tree below a prefix.
    fn read(&mut self, prefix: &[String]) {
        let mut segments = prefix.to_vec();
        if segments.is_empty() && self.next_is("::") {
            // The name of a crate follows.
            self.at += 1;
            segments.push(String::new());
        }
        while let Some(token) = self.tokens.get(self.at) {
            self.at += 1;
            if token.is("{") {
                while self.at < self.tokens.len() && !self.next_is("}") {
                    self.read(&segments);
                    self.at += usize::from(self.next_is(","));
                }
                self.at += 1;
                return;
            }
            if token.is("*") {
                return self.push(segments, "*", token.line);
            }
            if token.kind != Kind::Name {
                return;
            }
            if token.text != "self" || segments.is_empty() {
                segments.push(token.text.to_owned());
            }
            if self.next_is("::") {
                self.at += 1;
                continue;
            }
            let name = segments.last().cloned().unwrap_or_default();
            return match self.tokens[self.at..] {
                [keyword, alias, ..] if keyword.is_name("as") => {
                    self.at += 2;
                    self.push(segments, alias.text, token.line);
                }
                _ => self.push(segments, &name, token.line),
            };
        }
    }

    fn push(&mut self, segments: Vec<String>, name: &str, line: usize) {
        let path = Path { segments, line };
        self.found.push(Use { path, name: name.to_owned(), is_public: self.is_public });
    }
}
