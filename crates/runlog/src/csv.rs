//! Lines of comma-separated values (RFC 4180, without line breaks in values).

/// Returns a value as written in a line.
pub fn quoted(text: &str) -> String {
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// Returns the values of a line; `None` for unbalanced quotation marks.
pub fn values(line: &str) -> Option<Vec<String>> {
    let mut values = Vec::new();
    let mut rest = line;
    loop {
        let (value, after) = first_value(rest)?;
        values.push(value);
        match after.strip_prefix(',') {
            Some(more) => rest = more,
            None => return after.is_empty().then_some(values),
        }
    }
}

fn first_value(line: &str) -> Option<(String, &str)> {
    let Some(mut rest) = line.strip_prefix('"') else {
        let (value, after) = line.split_at(line.find(',').unwrap_or(line.len()));
        return Some((value.to_owned(), after));
    };
    let mut value = String::new();
    loop {
        let (part, after) = rest.split_once('"')?;
        value.push_str(part);
        match after.strip_prefix('"') {
            Some(more) => rest = more,
            None => return Some((value, after)),
        }
        value.push('"');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_round_trip() {
        let texts = ["loss", "", "ap, small", "12\" pipe", "\"", ",", "\"a\",\"b\"", "é"];
        let line = texts.map(quoted).join(",");
        assert_eq!(values(&line).unwrap(), texts);
        assert_eq!(values("").unwrap(), [""]);
        assert_eq!(values("\"cut"), None);
        assert_eq!(values("\"a\"b,c"), None);
    }
}
