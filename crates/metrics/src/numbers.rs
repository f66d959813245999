//! Whether a number is one that its metric documents.

use crate::{MetricEntry, Report};

/// The numbers of a report that its metric does not document: none, or a test has found a fault.
pub fn undocumented<'a>(entry: &MetricEntry, report: &'a Report) -> Vec<&'a str> {
    let known = |key: &str| entry.numbers.iter().any(|(pattern, _)| matches(pattern, key));
    report.statistics.scalars.keys().map(String::as_str).filter(|key| !known(key)).collect()
}

/// Whether `key` is `pattern` with something in place of each `<word>`.
fn matches(pattern: &str, key: &str) -> bool {
    let Some((before, rest)) = pattern.split_once('<') else { return pattern == key };
    let (Some(key), Some((_, rest))) = (key.strip_prefix(before), rest.split_once('>')) else { return false };
    (1..=key.len()).filter(|end| key.is_char_boundary(*end)).any(|end| matches(rest, &key[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn something_stands_in_place_of_a_word() {
        for (pattern, key, wanted) in [
            ("map", "map", true),
            ("map", "map50", false),
            ("top_<k>_accuracy", "top_5_accuracy", true),
            ("top_<k>_accuracy", "top__accuracy", false),
            ("<class>_<kind>", "car_3d", true),
            ("<class>_<kind>", "car", false),
        ] {
            assert_eq!(matches(pattern, key), wanted, "{pattern} {key}");
        }
    }
}
