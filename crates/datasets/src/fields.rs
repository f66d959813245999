//! Fields of a line of text, parsed as finite numbers.

use std::ops::RangeInclusive;

/// The fields of a line; error messages count fields from 1.
pub(crate) struct Fields<'a>(Vec<&'a str>);

impl<'a> Fields<'a> {
    /// Splits at commas and trims blanks.
    pub(crate) fn between_commas(line: &'a str) -> Self {
        Self(line.trim().trim_end_matches(',').split(',').map(str::trim).collect())
    }

    /// Splits at commas or, if there are none, at blanks.
    pub(crate) fn of(line: &'a str) -> Self {
        if line.contains(',') { Self::between_commas(line) } else { Self(line.split_whitespace().collect()) }
    }

    /// Returns the number of fields.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Checks the number of fields.
    pub(crate) fn expect(&self, counts: RangeInclusive<usize>) -> Result<(), String> {
        if counts.contains(&self.len()) {
            return Ok(());
        }
        let (least, most) = counts.into_inner();
        let expected = if least == most { least.to_string() } else { format!("{least} to {most}") };
        Err(format!("has {} fields instead of {expected}", self.len()))
    }

    /// Returns the field `index`, from 0.
    pub(crate) fn text(&self, index: usize) -> Result<&'a str, String> {
        self.0.get(index).copied().ok_or_else(|| format!("has no field {}", index + 1))
    }

    /// Parses a finite number.
    pub(crate) fn number(&self, index: usize) -> Result<f32, String> {
        let text = self.text(index)?;
        text.parse()
            .ok()
            .filter(|number: &f32| number.is_finite())
            .ok_or_else(|| format!("has {text:.40?} in field {} instead of a finite number", index + 1))
    }

    /// Parses finite numbers from field `index` on.
    pub(crate) fn numbers<const N: usize>(&self, index: usize) -> Result<[f32; N], String> {
        let mut numbers = [0.0; N];
        for (offset, number) in numbers.iter_mut().enumerate() {
            *number = self.number(index + offset)?;
        }
        Ok(numbers)
    }

    /// Parses an integer, which may be written as `3.0`.
    pub(crate) fn whole(&self, index: usize) -> Result<i64, String> {
        let text = self.text(index)?;
        let digits = text.split_once('.').filter(|(_, rest)| rest.bytes().all(|byte| byte == b'0'));
        digits
            .map_or(text, |(whole, _)| whole)
            .parse()
            .map_err(|_| format!("has {text:.40?} in field {} instead of an integer", index + 1))
    }
}

/// Returns the lines of a text that are not empty, with line numbers from 1.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = (u64, &str)> {
    (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty())
}
