//! Class names in the metadata of a network.

/// Reads the class names of a Python dictionary `{0: 'person', 1: "car"}`, of a list, or of the same in JSON. Returns `None` for
/// other texts, and when the indices are not 0, 1, 2, ...
pub fn class_names(text: &str) -> Option<Vec<String>> {
    let text = text.trim();
    let (is_keyed, inner) = match (text.strip_prefix('{'), text.strip_prefix('[')) {
        (Some(inner), _) => (true, inner.strip_suffix('}')?),
        (None, Some(inner)) => (false, inner.strip_suffix(']')?),
        (None, None) => return None,
    };
    let mut names = Vec::new();
    let mut rest = inner.trim_start();
    while !rest.is_empty() {
        if is_keyed {
            let (key, value) = rest.split_once(':')?;
            let key: usize = key.trim().trim_matches(['"', '\'']).parse().ok()?;
            if key != names.len() {
                return None;
            }
            rest = value.trim_start();
        }
        let (name, after) = quoted(rest)?;
        names.push(name);
        let after = after.trim_start();
        rest = match after.strip_prefix(',') {
            Some(more) => more.trim_start(),
            None if after.is_empty() => after,
            None => return None,
        };
    }
    Some(names)
}

/// Returns the text of the quoted string at the beginning, and what follows it.
fn quoted(text: &str) -> Option<(String, &str)> {
    let quote = text.chars().next().filter(|first| ['"', '\''].contains(first))?;
    let mut name = String::new();
    let mut chars = text.char_indices().skip(1);
    while let Some((at, char)) = chars.next() {
        match char {
            '\\' => name.push(chars.next()?.1),
            char if char == quote => return Some((name, text.get(at + 1..)?)),
            char => name.push(char),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dictionaries_and_lists_are_read() {
        let dictionary = r#"{0: 'person', 1: "driver's, seat", 2: 'it\'s'}"#;
        assert_eq!(class_names(dictionary).unwrap(), ["person", "driver's, seat", "it's"]);
        assert_eq!(class_names(r#"{"0": "a", "1": "b"}"#).unwrap(), ["a", "b"]);
        assert_eq!(class_names("['a', 'b', ]").unwrap(), ["a", "b"]);
        assert_eq!(class_names("{}").unwrap(), [""; 0]);
    }

    #[test]
    fn other_texts_are_refused() {
        for text in
            ["", "person", "{0: 'a'", "{0: a}", "{1: 'a'}", "{0: 'a' 1: 'b'}", "['a", "[1, 2]", "{0 'a'}"]
        {
            assert_eq!(class_names(text), None, "{text}");
        }
    }
}
