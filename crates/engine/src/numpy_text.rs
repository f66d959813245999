//! Text of arrays as NumPy prints them, for the `Display` of OpenDR's data and targets.
//!
//! It follows NumPy 1.14 to 2.1. Later versions differ in two places: `repr` of more than 1000 elements names the shape
//! (2.2), and `float32` becomes scientific from 1e6 instead of 1e8 (2.3).

use std::fmt::Write as _;

/// Characters per line, NumPy's default.
const LINE: usize = 75;
/// Arrays with more elements are printed by their edges only.
const SUMMARY: usize = 1000;
const EDGE: usize = 3;
/// Digits after the decimal point.
const PRECISION: usize = 8;

/// A number in an array; its type determines the digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Number {
    /// `float32`.
    F32(f32),
    /// `float64`.
    F64(f64),
    /// Any integer type.
    Int(i64),
}

impl Number {
    fn value(self) -> f64 {
        match self {
            Self::F32(value) => f64::from(value),
            Self::F64(value) => value,
            Self::Int(value) => value as f64,
        }
    }

    /// Returns the shortest digits that identify the number, at most [`PRECISION`] after the point; always with a point.
    fn positional(self) -> String {
        let shortest = match self {
            Self::F32(value) => value.to_string(),
            Self::F64(value) => value.to_string(),
            Self::Int(value) => value.to_string(),
        };
        let Some((_, digits)) = shortest.split_once('.') else { return shortest + "." };
        // Of two shortest texts at the same distance, NumPy takes the even one, as exact rounding does.
        let exact = format!("{:.*}", digits.len().min(PRECISION), self.value());
        let same = match self {
            Self::F32(value) => exact.parse() == Ok(value),
            _ => exact.parse() == Ok(self.value()),
        };
        if same || digits.len() > PRECISION { exact.trim_end_matches('0').to_owned() } else { shortest }
    }

    /// Returns integer digits, digits after the point, and exponent of the scientific form.
    fn scientific(self) -> (String, String, i32) {
        let text = match self {
            Self::F32(value) => format!("{value:e}"),
            _ => format!("{:e}", self.value()),
        };
        let long = text
            .split_once('e')
            .is_some_and(|(mantissa, _)| mantissa.trim_start_matches('-').len() > PRECISION + 2);
        let text = if long { format!("{:.PRECISION$e}", self.value()) } else { text };
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let (whole, digits) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        (whole.to_owned(), digits.trim_end_matches('0').to_owned(), exponent.parse().unwrap_or(0))
    }
}

/// Returns `str(array)`.
pub(crate) fn array_str(shape: &[usize], number: &dyn Fn(usize) -> Number) -> String {
    Printer::new(shape, number, " ", 0).print()
}

/// Returns `repr(array)` of a float array.
pub(crate) fn array_repr(shape: &[usize], number: &dyn Fn(usize) -> Number) -> String {
    let mut text = format!("array({}", Printer::new(shape, number, ", ", "array(".len()).print());
    if shape.contains(&0) {
        text += ", dtype=float64";
    }
    text + ")"
}

struct Printer<'a> {
    shape: &'a [usize],
    number: &'a dyn Fn(usize) -> Number,
    separator: &'static str,
    indent: usize,
    style: Style,
    summary: bool,
}

enum Style {
    Int { width: usize },
    Positional { left: usize, right: usize },
    Scientific { left: usize, digits: usize, exponent: usize },
}

impl<'a> Printer<'a> {
    fn new(
        shape: &'a [usize],
        number: &'a dyn Fn(usize) -> Number,
        separator: &'static str,
        indent: usize,
    ) -> Self {
        let summary = shape.iter().product::<usize>() > SUMMARY;
        let mut printer = Self { shape, number, separator, indent, style: Style::Int { width: 0 }, summary };
        let mut printed = Vec::new();
        printer.visit(0, 0, &mut |at| printed.push(number(at)));
        printer.style = Style::of(&printed);
        printer
    }

    /// Calls `each` with the index of every printed element.
    fn visit(&self, axis: usize, at: usize, each: &mut dyn FnMut(usize)) {
        match self.shape.get(axis) {
            None => each(at),
            Some(&count) => {
                self.printed(count).for_each(|index| self.visit(axis + 1, at * count + index, each))
            }
        }
    }

    /// Returns the printed indices along an axis; a summary leaves out the middle.
    fn printed(&self, count: usize) -> impl Iterator<Item = usize> {
        let cut = self.summary && count > 2 * EDGE;
        (0..count).filter(move |index| !cut || *index < EDGE || *index >= count - EDGE)
    }

    fn print(&self) -> String {
        if self.shape.contains(&0) {
            return "[]".to_owned();
        }
        // The closing parenthesis of `repr` takes one character.
        let width = LINE - usize::from(self.indent > 0);
        self.nested(0, 0, &" ".repeat(self.indent + 1), width)
    }

    fn nested(&self, axis: usize, at: usize, hanging: &str, width: usize) -> String {
        let Some(&count) = self.shape.get(axis) else { return self.style.text((self.number)(at)) };
        let cut = self.summary && count > 2 * EDGE;
        let parts = self.printed(count).map(|index| {
            let text = self.nested(axis + 1, at * count + index, &format!("{hanging} "), width - 1);
            (cut && index == count - EDGE, text)
        });
        let last = axis + 1 == self.shape.len();
        let body = if last { self.row(parts, hanging, width) } else { self.rows(parts, hanging, axis) };
        format!("[{}]", body.get(hanging.len()..).unwrap_or_default())
    }

    fn row(&self, parts: impl Iterator<Item = (bool, String)>, hanging: &str, width: usize) -> String {
        let width = width - self.separator.trim_end().len().max(1);
        let (mut text, mut line) = (String::new(), hanging.to_owned());
        let mut extend = |word: &str, line: &mut String| {
            if line.len() + word.len() > width && line.len() > hanging.len() {
                text += line.trim_end();
                text.push('\n');
                hanging.clone_into(line);
            }
            *line += word;
        };
        let mut first = true;
        for (after_gap, word) in parts {
            if !std::mem::take(&mut first) {
                line += self.separator;
            }
            if after_gap {
                extend("...", &mut line);
                line += self.separator;
            }
            extend(&word, &mut line);
        }
        text + &line
    }

    fn rows(&self, parts: impl Iterator<Item = (bool, String)>, hanging: &str, axis: usize) -> String {
        let between = self.separator.trim_end().to_owned() + &"\n".repeat(self.shape.len() - axis - 1);
        let mut text = String::new();
        for (after_gap, part) in parts {
            if !text.is_empty() {
                text += &between;
            }
            if after_gap {
                text += hanging;
                text += "...";
                text += &between;
            }
            text += hanging;
            text += &part;
        }
        text
    }
}

impl Style {
    fn of(numbers: &[Number]) -> Self {
        if matches!(numbers.first(), Some(Number::Int(_))) {
            let widths = numbers.iter().map(|number| format!("{}", number.value()).len());
            return Self::Int { width: widths.max().unwrap_or(0) };
        }
        let finite = || numbers.iter().copied().filter(|number| number.value().is_finite());
        let sizes = || finite().map(|number| number.value().abs()).filter(|size| *size > 0.0);
        let (most, least) = (sizes().fold(0.0, f64::max), sizes().fold(f64::INFINITY, f64::min));
        let special = numbers.iter().filter(|number| !number.value().is_finite());
        let special = special.map(|number| special_text(number.value()).len()).max().unwrap_or(0);
        // NumPy compares in the element type of the array.
        let wide = match numbers.first() {
            Some(Number::F32(_)) => {
                let (most, least) = (most as f32, least as f32);
                most >= 1e8 || least < 1e-4 || most / least > 1000.0
            }
            _ => most >= 1e8 || least < 1e-4 || most / least > 1000.0,
        };
        if most > 0.0 && wide {
            return Self::scientific(finite(), special);
        }
        let (mut left, mut right) = (0, 0);
        for number in finite() {
            let text = number.positional();
            let point = text.find('.').unwrap_or(text.len());
            left = left.max(point);
            right = right.max(text.len() - point - 1);
        }
        Self::Positional { left: left.max(special.saturating_sub(right + 1)), right }
    }

    fn scientific(numbers: impl Iterator<Item = Number>, special: usize) -> Self {
        let (mut left, mut digits, mut exponent) = (0, 0, 2);
        for number in numbers {
            let (whole, fraction, power) = number.scientific();
            left = left.max(whole.len());
            digits = digits.max(fraction.len());
            exponent = exponent.max(power.abs().to_string().len());
        }
        Self::Scientific { left: left.max(special.saturating_sub(digits + exponent + 3)), digits, exponent }
    }

    fn text(&self, number: Number) -> String {
        let value = number.value();
        match *self {
            Self::Int { width } => format!("{:>width$}", format!("{value}")),
            Self::Positional { left, right } if !value.is_finite() => {
                format!("{:>width$}", special_text(value), width = left + right + 1)
            }
            Self::Scientific { left, digits, exponent } if !value.is_finite() => {
                format!("{:>width$}", special_text(value), width = left + digits + exponent + 3)
            }
            Self::Positional { left, right } => {
                let text = number.positional();
                let (whole, digits) = text.split_once('.').unwrap_or((&text, ""));
                format!("{whole:>left$}.{digits:<right$}")
            }
            Self::Scientific { left, digits, exponent } => {
                // NumPy pads with the digits of the exact value, not with zeros.
                let exact = format!("{value:.digits$e}");
                let (mantissa, power) = exact.split_once('e').unwrap_or((&exact, "0"));
                let power: i32 = power.parse().unwrap_or(0);
                let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
                let sign = if power < 0 { '-' } else { '+' };
                let mut text = format!("{whole:>left$}.{fraction}e{sign}");
                // Writing to a String cannot fail.
                write!(text, "{:0>exponent$}", power.abs()).ok();
                text
            }
        }
    }
}

fn special_text(value: f64) -> &'static str {
    if value.is_nan() {
        "nan"
    } else if value > 0.0 {
        "inf"
    } else {
        "-inf"
    }
}

/// Returns the text of a number as Python prints it in a list.
pub(crate) fn python_float(value: f32) -> String {
    if value != 0.0 && value.is_finite() && !(1e-4..1e16).contains(&value.abs()) {
        let text = format!("{value:e}");
        let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
        let power: i32 = power.parse().unwrap_or(0);
        return format!("{mantissa}e{}{:02}", if power < 0 { '-' } else { '+' }, power.abs());
    }
    let text = value.to_string();
    if text.contains(['.', 'N', 'i']) { text.to_lowercase() } else { text + ".0" }
}

#[cfg(test)]
mod tests;
