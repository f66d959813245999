//! The subset of YAML of YOLO's `data.yaml`: keys with a text, a list, or a table of numbers and names.

use std::path::Path;

use opendr_engine::Result;

use crate::Problem;

/// Value of a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Yaml {
    Text(String),
    List(Vec<String>),
    Table(Vec<(String, String)>),
}

/// Keys of a file, in order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Keys(Vec<(String, Yaml)>);

impl Keys {
    /// Parses `text`, the content of `file`.
    ///
    /// # Errors
    /// `Format`, with the line, for other YAML.
    pub fn new(file: &Path, text: &str) -> Result<Self> {
        let wrong = |line: usize, what: &str| Problem::at_line(file, line as u64 + 1, what);
        let lines: Vec<&str> = text.lines().map(without_comment).collect();
        let (mut keys, mut at) = (Vec::new(), 0);
        while let Some(line) = lines.get(at) {
            let start = at;
            at += 1;
            if line.is_empty() || *line == "---" || *line == "..." {
                continue;
            }
            let pair = line.split_once(':').filter(|_| !line.starts_with([' ', '\t', '-']));
            let (key, value) =
                pair.ok_or_else(|| wrong(start, "the line is not \"key: value\", as in YOLO's data.yaml"))?;
            let nested = lines[at..].iter().take_while(belongs).count();
            let inside = &lines[at..at + nested];
            at += nested;
            let value = value.trim();
            let value = match value.chars().next() {
                Some('|' | '>') => Yaml::Text(inside.join("\n")),
                Some('[' | '{') => {
                    let mut flow = value.to_owned();
                    // Lists in brackets may continue in lines of any indentation.
                    flow.extend(inside.iter().flat_map(|line| [" ", line.trim()]));
                    while !flow.ends_with([']', '}']) {
                        let more = lines.get(at).ok_or_else(|| wrong(start, "a bracket is not closed"))?;
                        flow.extend([" ", more.trim()]);
                        at += 1;
                    }
                    flow_value(&flow).ok_or_else(|| wrong(start, "the brackets do not contain names"))?
                }
                Some(_) => Yaml::Text(unquoted(value)),
                None => block(inside).map_err(|line| {
                    wrong(start + 1 + line, "the line is neither \"- name\" nor \"0: name\"")
                })?,
            };
            keys.push((unquoted(key), value));
        }
        Ok(Self(keys))
    }

    /// Returns the value of `key`.
    pub fn get(&self, key: &str) -> Option<&Yaml> {
        self.0.iter().find(|(name, _)| name == key).map(|(_, value)| value)
    }

    /// Returns the text of `key`, or its list of texts.
    pub fn texts(&self, key: &str) -> &[String] {
        match self.get(key) {
            Some(Yaml::Text(text)) => std::slice::from_ref(text),
            Some(Yaml::List(list)) => list,
            _ => &[],
        }
    }

    /// Returns the keys.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|(name, _)| name.as_str())
    }
}

/// Returns whether a line belongs to the key above it.
fn belongs(line: &&&str) -> bool {
    line.is_empty() || line.starts_with([' ', '\t', '-'])
}

fn without_comment(line: &str) -> &str {
    let (mut quote, mut before) = (None, ' ');
    let end = line.char_indices().find(|(_, letter)| {
        let comment = quote.is_none() && *letter == '#' && before.is_whitespace();
        match quote {
            Some(open) if open == *letter => quote = None,
            None if matches!(letter, '"' | '\'') && !before.is_alphanumeric() => quote = Some(*letter),
            _ => {}
        }
        before = *letter;
        comment
    });
    line[..end.map_or(line.len(), |(at, _)| at)].trim_end()
}

fn unquoted(text: &str) -> String {
    let text = text.trim();
    let inside = |quote: char| text.strip_prefix(quote).and_then(|rest| rest.strip_suffix(quote));
    inside('"').or_else(|| inside('\'')).unwrap_or(text).to_owned()
}

/// Parses `[a, b]` or `{0: a, 1: b}`.
fn flow_value(text: &str) -> Option<Yaml> {
    let list = text.starts_with('[');
    let inside = if list {
        text.strip_prefix('[')?.strip_suffix(']')?
    } else {
        text.strip_prefix('{')?.strip_suffix('}')?
    };
    let (mut parts, mut quote) = (vec![String::new()], None);
    for letter in inside.chars() {
        match (quote, letter) {
            (None, ',') => parts.push(String::new()),
            (None, '[' | '{') => return None,
            (None, '"' | '\'') => quote = Some(letter),
            (Some(open), _) if open == letter => quote = None,
            _ => {}
        }
        if letter != ',' || quote.is_some() {
            parts.last_mut()?.push(letter);
        }
    }
    let mut parts: Vec<_> = parts.iter().map(|part| part.trim()).collect();
    parts.pop_if(|last| last.is_empty());
    if list {
        return Some(Yaml::List(parts.into_iter().map(unquoted).collect()));
    }
    parts.into_iter().map(entry).collect::<Option<_>>().map(Yaml::Table)
}

/// Parses lines `- a`, or lines `0: a`; the error is the index of a line that is neither.
fn block(lines: &[&str]) -> Result<Yaml, usize> {
    let trimmed = || lines.iter().map(|line| line.trim()).enumerate().filter(|(_, line)| !line.is_empty());
    if trimmed().next().is_some_and(|(_, line)| line.starts_with('-')) {
        let item = |(at, line): (usize, &str)| line.strip_prefix('-').map(unquoted).ok_or(at);
        return trimmed().map(item).collect::<Result<_, _>>().map(Yaml::List);
    }
    trimmed().map(|(at, line)| entry(line).ok_or(at)).collect::<Result<_, _>>().map(Yaml::Table)
}

fn entry(text: &str) -> Option<(String, String)> {
    text.split_once(':').map(|(key, value)| (unquoted(key), unquoted(value)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(text: &str) -> Result<Keys> {
        Keys::new(Path::new("data.yaml"), text)
    }

    #[test]
    fn common_forms_of_files() {
        let text = "# COCO\npath: .  # here\ntrain: images/train\nval:\n  - a b\n  - 'c: d'\n\nnames:\n  0: person\n  1: \"hot dog\" # no cat\n\
                    download: |\n  import x\n  y: [\nnc: 2\n";
        let keys = keys(text).unwrap();
        assert_eq!(
            (keys.texts("path"), keys.texts("val")),
            (&[".".into()][..], &["a b".into(), "c: d".into()][..])
        );
        let names = Yaml::Table(vec![("0".into(), "person".into()), ("1".into(), "hot dog".into())]);
        assert_eq!(keys.get("names"), Some(&names));
        assert_eq!(keys.names().collect::<Vec<_>>(), ["path", "train", "val", "names", "download", "nc"]);
    }

    #[test]
    fn lists_in_brackets_may_span_lines() {
        let list = |text: &str| keys(text).unwrap().texts("names").to_vec();
        assert_eq!(list("names: ['a', \"b, c\",\n 'd e']\nnc: 3"), ["a", "b, c", "d e"]);
        assert_eq!(list("names: [a,\nb]"), ["a", "b"]);
        assert_eq!(list("names:\n- a\n- b # c"), ["a", "b"]);
        let table = Yaml::Table(vec![("0".into(), "a".into()), ("1".into(), "b".into())]);
        assert_eq!(keys("names: {0: a, 1: b}").unwrap().get("names"), Some(&table));
    }

    #[test]
    fn errors_name_the_line() {
        let error = |text: &str| keys(text).unwrap_err().to_string();
        assert!(error("path: .\nnonsense").starts_with("data.yaml:2: the line is not \"key: value\""));
        assert!(error("names:\n  0: a\n  b\n").starts_with("data.yaml:3: the line is neither"));
        assert!(error("names: [a,\n b").starts_with("data.yaml:1: a bracket"));
        assert!(error("names: [[a]]").starts_with("data.yaml:1: the brackets"));
    }
}
