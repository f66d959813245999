//! Lexer of Rust, C and Python: comments, string literals, names and symbols.

/// Language of a source file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Language {
    Rust,
    C,
    Python,
}

/// Kind of a token. White space, numbers, characters and lifetimes are no tokens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Comment,
    Literal,
    Name,
    /// One character, or `::`.
    Symbol,
}

/// A token of a source file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Token<'a> {
    pub kind: Kind,
    /// Source text, with the delimiters of comments and literals.
    pub text: &'a str,
    /// Line of the first character, from 1.
    pub line: usize,
    /// Byte in its line of the first character, from 0.
    pub column: usize,
}

impl Token<'_> {
    /// Returns whether the token is this symbol.
    pub fn is(&self, symbol: &str) -> bool {
        self.kind == Kind::Symbol && self.text == symbol
    }

    /// Returns the change of the nesting depth: 1 for an opening bracket, -1 for a closing one, otherwise 0.
    pub fn nesting(&self) -> i32 {
        match self.text {
            "(" | "[" | "{" if self.kind == Kind::Symbol => 1,
            ")" | "]" | "}" if self.kind == Kind::Symbol => -1,
            _ => 0,
        }
    }

    /// Returns whether the token is this name or keyword.
    pub fn is_name(&self, name: &str) -> bool {
        self.kind == Kind::Name && self.text == name
    }
}

/// Splits a source text into tokens.
pub fn tokens(source: &str, language: Language) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let (mut at, mut line, mut line_start) = (0, 1, 0);
    while at < source.len() {
        let rest = &source[at..];
        let (kind, length) = match language {
            Language::Python => next_of_python(rest),
            Language::Rust | Language::C => next_of_rust_or_c(rest, language),
        };
        let text = &rest[..length];
        if let Some(kind) = kind {
            tokens.push(Token { kind, text, line, column: at - line_start });
        }
        line += text.bytes().filter(|byte| *byte == b'\n').count();
        if let Some(last) = text.rfind('\n') {
            line_start = at + last + 1;
        }
        at += length;
    }
    tokens
}

/// Returns the kind and the length of what `rest` begins with.
fn next_of_rust_or_c(rest: &str, language: Language) -> (Option<Kind>, usize) {
    if rest.starts_with("//") {
        return (Some(Kind::Comment), line_length(rest));
    }
    if rest.starts_with("/*") {
        return (Some(Kind::Comment), block_comment_length(rest, language == Language::Rust));
    }
    if let Some(length) = literal_length(rest) {
        return (Some(Kind::Literal), length);
    }
    if let Some(quoted) = rest.strip_prefix("b'").or_else(|| rest.strip_prefix('\'')) {
        return (None, rest.len() - quoted.len() + character_length(quoted));
    }
    if rest.starts_with("::") {
        return (Some(Kind::Symbol), 2);
    }
    next_of_any(rest)
}

fn next_of_python(rest: &str) -> (Option<Kind>, usize) {
    if rest.starts_with('#') {
        return (Some(Kind::Comment), line_length(rest));
    }
    let prefix = rest.bytes().take_while(|byte| b"rRbBuUfFtT".contains(byte)).count();
    let quoted = &rest[prefix..];
    for quote in ["\"\"\"", "'''", "\"", "'"] {
        if prefix <= 2 && quoted.starts_with(quote) {
            let content = &quoted[quote.len()..];
            return (Some(Kind::Literal), prefix + quote.len() + quoted_length(content, quote));
        }
    }
    next_of_any(rest)
}

/// Returns what `rest` begins with in every language: white space, a number, a name or a symbol.
fn next_of_any(rest: &str) -> (Option<Kind>, usize) {
    let first = rest.chars().next().unwrap_or_default();
    let while_of = |wanted: fn(char) -> bool| rest.find(|letter| !wanted(letter)).unwrap_or(rest.len());
    match first {
        first if first.is_whitespace() => (None, while_of(char::is_whitespace)),
        first if first.is_ascii_digit() => (None, while_of(is_of_name)),
        first if is_of_name(first) => (Some(Kind::Name), while_of(is_of_name)),
        first => (Some(Kind::Symbol), first.len_utf8()),
    }
}

fn is_of_name(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

fn line_length(rest: &str) -> usize {
    rest.find('\n').unwrap_or(rest.len())
}

/// Returns the length of a block comment; those of Rust are nested.
fn block_comment_length(rest: &str, nested: bool) -> usize {
    let (mut at, mut depth) = (2, 1);
    while depth > 0 {
        match (rest[at..].find("*/"), rest[at..].find("/*")) {
            (Some(end), Some(begin)) if nested && begin < end => (at, depth) = (at + begin + 2, depth + 1),
            (Some(end), _) => (at, depth) = (at + end + 2, depth - 1),
            (None, _) => return rest.len(),
        }
    }
    at
}

/// Returns the length of the string literal of Rust or C that `rest` begins with.
fn literal_length(rest: &str) -> Option<usize> {
    let unprefixed = rest.strip_prefix(['b', 'c']).unwrap_or(rest);
    let prefix = rest.len() - unprefixed.len();
    if let Some(content) = unprefixed.strip_prefix('"') {
        return Some(prefix + 1 + quoted_length(content, "\""));
    }
    let raw = unprefixed.strip_prefix('r')?;
    let hashes = raw.bytes().take_while(|byte| *byte == b'#').count();
    let content = raw[hashes..].strip_prefix('"')?;
    let quote = format!("\"{}", &raw[..hashes]);
    let length = content.find(&quote).map_or(content.len(), |end| end + quote.len());
    Some(rest.len() - content.len() + length)
}

/// Returns the length of the rest of a literal, with its closing `quote`. A backslash escapes the next character.
fn quoted_length(content: &str, quote: &str) -> usize {
    let mut at = 0;
    while let Some(found) = content[at..].find(['\\', '"', '\'']) {
        at += found;
        if content[at..].starts_with(quote) {
            return at + quote.len();
        }
        let escaped = content[at..].starts_with('\\');
        at += content[at..].chars().take(if escaped { 2 } else { 1 }).map(char::len_utf8).sum::<usize>();
    }
    content.len()
}

/// Returns the length of the rest of a character literal, or of a lifetime.
fn character_length(quoted: &str) -> usize {
    let first = quoted.chars().next().unwrap_or_default();
    if first == '\\' {
        return quoted_length(quoted, "'");
    }
    match quoted[first.len_utf8().min(quoted.len())..].starts_with('\'') {
        true => first.len_utf8() + 1,
        false => quoted.find(|letter| !is_of_name(letter)).unwrap_or(quoted.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_kind(source: &str, language: Language, kind: Kind) -> Vec<&str> {
        tokens(source, language).iter().filter(|token| token.kind == kind).map(|token| token.text).collect()
    }

    #[test]
    fn rust_is_split() {
        let source = r####"/* a /* b */ c */ let x: &'static str = "d \" // e"; // f
            let y = (r#"g " h"#, b"i", '"', '\'', b'\\', 'é', 'k'); x.0::<'a>("j")"####;
        assert_eq!(of_kind(source, Language::Rust, Kind::Comment), ["/* a /* b */ c */", "// f"]);
        let literals = [r#""d \" // e""#, r###"r#"g " h"#"###, "b\"i\"", "\"j\""];
        assert_eq!(of_kind(source, Language::Rust, Kind::Literal), literals);
        assert_eq!(of_kind(source, Language::Rust, Kind::Name), ["let", "x", "str", "let", "y", "x"]);
        let symbols = of_kind(source, Language::Rust, Kind::Symbol).concat();
        assert_eq!(symbols, ":&=;=(,,,,,,);.::<>()");
    }

    #[test]
    fn python_is_split() {
        let source = "def f():\n    '''a\n    \"b'''\n    return rb\"c # d\" + f'e'  # g\n";
        assert_eq!(
            of_kind(source, Language::Python, Kind::Literal),
            ["'''a\n    \"b'''", "rb\"c # d\"", "f'e'"]
        );
        assert_eq!(of_kind(source, Language::Python, Kind::Comment), ["# g"]);
        assert_eq!(of_kind(source, Language::Python, Kind::Name), ["def", "f", "return"]);
        let place = tokens(source, Language::Python).pop().map(|token| (token.line, token.column));
        assert_eq!(place, Some((4, 29)));
    }

    #[test]
    fn comments_of_c_are_not_nested() {
        assert_eq!(of_kind("/* a /* b */ c", Language::C, Kind::Name), ["c"]);
    }

    #[test]
    fn unfinished_tokens_end_with_the_text() {
        for source in ["\"a", "/* a", "r#\"a\"", "'", "'\\", "\"a\\", "é"] {
            for language in [Language::Rust, Language::C, Language::Python] {
                let last = tokens(source, language).pop();
                assert!(last.is_none_or(|last| source.ends_with(last.text)), "{source}");
            }
        }
    }
}
