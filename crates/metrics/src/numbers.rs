//! Check that the numbers of reports are documented.

use crate::{MetricEntry, Report};

/// Returns the numbers of a report that its metric does not document. There are none; others are found by tests.
pub fn undocumented<'a>(entry: &MetricEntry, report: &'a Report) -> Vec<&'a str> {
    let known = |key: &str| entry.numbers.iter().any(|(pattern, _)| matches(pattern, key));
    report.statistics.scalars.keys().map(String::as_str).filter(|key| !known(key)).collect()
}

/// Returns whether `key` is `pattern` with any text in place of each `<word>`.
fn matches(pattern: &str, key: &str) -> bool {
    let Some((before, rest)) = pattern.split_once('<') else { return pattern == key };
    let (Some(key), Some((_, rest))) = (key.strip_prefix(before), rest.split_once('>')) else { return false };
    (1..=key.len()).filter(|end| key.is_char_boundary(*end)).any(|end| matches(rest, &key[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn placeholders_match_any_text() {
        for (pattern, key, expected) in [
            ("map", "map", true),
            ("map", "map50", false),
            ("top_<k>_accuracy", "top_5_accuracy", true),
            ("top_<k>_accuracy", "top__accuracy", false),
            ("<class>_<kind>", "car_3d", true),
            ("<class>_<kind>", "car", false),
        ] {
            assert_eq!(matches(pattern, key), expected, "{pattern} {key}");
        }
    }
}
