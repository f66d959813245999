//! Texts of arrays in a dictionary as Python prints them, for `str(kitti())`.

use std::fmt::Write as _;

use crate::numpy_text::{Number, array_repr};
use crate::target::Name;

/// Characters per line, elements before a summary, elements at each end of one: NumPy's defaults.
const LINE: usize = 75;
const SUMMARY: usize = 1000;
const EDGE: usize = 3;
const PREFIX: &str = "array(";

/// Returns `repr(text)`.
pub(super) fn python_str(text: &str) -> String {
    let quote = if text.contains('\'') && !text.contains('"') { '"' } else { '\'' };
    let mut out = String::from(quote);
    for c in text.chars() {
        match c {
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            '\\' => out.push_str("\\\\"),
            c if c == quote => out.extend(['\\', c]),
            c if (c as u32) < 0x20 || c as u32 == 0x7f => {
                // Writing to a String cannot fail.
                write!(out, "\\x{:02x}", c as u32).ok();
            }
            c => out.push(c),
        }
    }
    out.push(quote);
    out
}

/// Returns `repr` of an array of Python floats, `[count]` or `[count, N]`.
pub(super) fn floats<const N: usize>(rows: &[[f32; N]]) -> String {
    let shape = if N == 1 || rows.is_empty() { &[rows.len()][..] } else { &[rows.len(), N] };
    array_repr(shape, &|at| Number::F64(as_python(rows[at / N][at % N])))
}

/// Returns the `float64` of the shortest digits, as if the number had been typed in Python.
fn as_python(number: f32) -> f64 {
    number.to_string().parse().unwrap_or(f64::NAN)
}

/// Returns `repr` of an array of `int64`.
pub(super) fn integers(numbers: &[i64]) -> String {
    array_repr(&[numbers.len()], &|at| Number::Int(numbers[at]))
}

/// Returns `repr` of an array of `int32`.
pub(super) fn integers32(numbers: &[i32]) -> String {
    if numbers.is_empty() {
        return "array([], dtype=int32)".to_owned();
    }
    let text = array_repr(&[numbers.len()], &|at| Number::Int(numbers[at].into()));
    with_dtype(text.strip_suffix(')').unwrap_or(&text), "int32")
}

/// Returns `repr` of an array of class indices, or of labels if there is at least one label.
pub(super) fn names(names: &[Name]) -> String {
    let index = |name: &Name| match name {
        Name::Index(index) => Some(*index),
        Name::Label(_) => None,
    };
    if let Some(numbers) = names.iter().map(index).collect::<Option<Vec<_>>>() {
        return integers(&numbers);
    }
    let labels: Vec<_> = names.iter().map(Name::to_string).collect();
    let width = labels.iter().map(|label| label.chars().count()).max().unwrap_or(0).max(1);
    let cut = labels.len() > SUMMARY;
    let hanging = " ".repeat(PREFIX.len() + 1);
    let (mut text, mut line) = (String::new(), format!("{PREFIX}["));
    let mut extend = |word: &str, separator: &str, line: &mut String| {
        if line.chars().count() + word.chars().count() >= LINE - 1 && line.len() > hanging.len() {
            text += line.trim_end();
            text.push('\n');
            line.clone_from(&hanging);
        }
        *line += word;
        *line += separator;
    };
    for (index, label) in labels.iter().enumerate() {
        let is_printed = !cut || index < EDGE || index >= labels.len() - EDGE;
        if cut && index == EDGE {
            extend("...", ", ", &mut line);
        }
        if is_printed {
            extend(&python_str(label), if index + 1 == labels.len() { "" } else { ", " }, &mut line);
        }
    }
    with_dtype(&(text + &line + "]"), &format!("'<U{width}'"))
}

/// Appends the type to the text of an array, on a line of its own if it does not fit.
fn with_dtype(array: &str, dtype: &str) -> String {
    let (array, dtype) = (format!("{array},"), format!("dtype={dtype})"));
    let last = array.rsplit('\n').next().unwrap_or_default().chars().count();
    let fits = last + dtype.len() < LINE;
    format!("{array}{}{dtype}", if fits { " ".to_owned() } else { format!("\n{}", " ".repeat(PREFIX.len())) })
}
