//! Nodes of a world file.

use std::fmt;

/// A node with its fields, in order.
#[derive(Debug, Clone)]
pub(super) struct Node {
    kind: String,
    fields: Vec<(&'static str, Value)>,
}

#[derive(Debug, Clone)]
enum Value {
    /// Numbers, words, quoted texts.
    Plain(String),
    Node(Node),
    Nodes(Vec<Node>),
}

impl Node {
    pub fn new(kind: &str) -> Self {
        Self { kind: kind.to_owned(), fields: Vec::new() }
    }

    /// Creates a node that controllers find by `name`.
    pub fn defined(name: &str, kind: &str) -> Self {
        Self::new(&format!("DEF {name} {kind}"))
    }

    #[must_use]
    fn with(mut self, name: &'static str, value: Value) -> Self {
        self.fields.push((name, value));
        self
    }

    /// Adds a field of words, such as `TRUE`.
    #[must_use]
    pub fn words(self, name: &'static str, words: &str) -> Self {
        self.with(name, Value::Plain(words.to_owned()))
    }

    #[must_use]
    pub fn numbers(self, name: &'static str, numbers: &[f64]) -> Self {
        let words: Vec<_> = numbers.iter().map(ToString::to_string).collect();
        self.words(name, &words.join(" "))
    }

    #[must_use]
    pub fn number(self, name: &'static str, number: f64) -> Self {
        self.numbers(name, &[number])
    }

    /// Adds a field with a list of numbers, `columns` in a line.
    #[must_use]
    pub fn list(self, name: &'static str, numbers: &[f64], columns: usize) -> Self {
        let line = |row: &[f64]| row.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
        let lines: Vec<_> = numbers.chunks(columns).map(line).collect();
        self.words(name, &format!("[\n{}\n]", lines.join("\n")))
    }

    #[must_use]
    pub fn text(self, name: &'static str, text: &str) -> Self {
        self.words(name, &quoted(text))
    }

    #[must_use]
    pub fn list_of_texts(self, name: &'static str, texts: &[&str]) -> Self {
        let texts: Vec<_> = texts.iter().copied().map(quoted).collect();
        self.words(name, &format!("[ {} ]", texts.join(", ")))
    }

    #[must_use]
    pub fn node(self, name: &'static str, node: Self) -> Self {
        self.with(name, Value::Node(node))
    }

    #[must_use]
    pub fn nodes(self, name: &'static str, nodes: Vec<Self>) -> Self {
        self.with(name, Value::Nodes(nodes))
    }

    fn write(&self, indent: usize, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let inner = indent + 2;
        writeln!(f, "{} {{", self.kind)?;
        for (name, value) in &self.fields {
            write!(f, "{:inner$}{name} ", "")?;
            match value {
                Value::Plain(words) => writeln!(f, "{words}")?,
                Value::Node(node) => node.write(inner, f)?,
                Value::Nodes(nodes) => {
                    writeln!(f, "[")?;
                    for node in nodes {
                        write!(f, "{:1$}", "", inner + 2)?;
                        node.write(inner + 2, f)?;
                    }
                    writeln!(f, "{:inner$}]", "")?;
                }
            }
        }
        writeln!(f, "{:indent$}}}", "")
    }
}

impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write(0, f)
    }
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
