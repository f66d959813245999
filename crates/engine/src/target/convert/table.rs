//! Lines of separated numbers, as in MOT and KITTI files.

use crate::{Error, Result};

/// The fields of a line; every error states the line.
pub(super) struct Row<'a> {
    fields: Vec<&'a str>,
    line: usize,
}

impl<'a> Row<'a> {
    /// Returns the lines of `text` that are not empty, split at `separator` or white space.
    pub(super) fn all(text: &'a str, separator: Option<char>) -> impl Iterator<Item = Self> {
        text.lines().enumerate().filter_map(move |(index, line)| {
            let cut = |c: char| c.is_whitespace() || Some(c) == separator;
            let fields: Vec<_> = line.split(cut).filter(|field| !field.is_empty()).collect();
            (!fields.is_empty()).then_some(Self { fields, line: index + 1 })
        })
    }

    pub(super) fn len(&self) -> usize {
        self.fields.len()
    }

    /// Checks the number of fields.
    pub(super) fn expect(&self, counts: std::ops::RangeInclusive<usize>) -> Result<()> {
        if counts.contains(&self.len()) {
            return Ok(());
        }
        let (least, most) = (counts.start(), counts.end());
        Err(self.wrong(&format!("has {} fields instead of {least} to {most}", self.len())))
    }

    pub(super) fn text(&self, index: usize) -> Result<&'a str> {
        self.fields.get(index).copied().ok_or_else(|| self.wrong(&format!("has no field {}", index + 1)))
    }

    /// Returns a finite number.
    pub(super) fn number(&self, index: usize) -> Result<f32> {
        let text = self.text(index)?;
        text.parse().ok().filter(|number: &f32| number.is_finite()).ok_or_else(|| {
            self.wrong(&format!("has {text:.40?} in field {} instead of a finite number", index + 1))
        })
    }

    /// Returns finite numbers from field `index` on.
    pub(super) fn numbers<const N: usize>(&self, index: usize) -> Result<[f32; N]> {
        let mut numbers = [0.0; N];
        for (offset, number) in numbers.iter_mut().enumerate() {
            *number = self.number(index + offset)?;
        }
        Ok(numbers)
    }

    /// Returns an integer, which may be written as `3.0`.
    pub(super) fn whole(&self, index: usize) -> Result<i64> {
        let text = self.text(index)?;
        let digits = text.split_once('.').filter(|(_, rest)| rest.bytes().all(|byte| byte == b'0'));
        let digits = digits.map_or(text, |(whole, _)| whole);
        digits
            .parse()
            .map_err(|_| self.wrong(&format!("has {text:.40?} in field {} instead of an integer", index + 1)))
    }

    pub(super) fn wrong(&self, what: &str) -> Error {
        Error::format(format!("line {} {what}; fix the file", self.line))
    }
}
