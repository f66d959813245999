//! Lines of one series, in both formats.

use opendr_engine::data::Timeseries;
use opendr_engine::target::Classes;

const MAX_DIMENSIONS: usize = 4096;

/// Header of a `.ts` file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct TsHeader {
    /// Name of the problem.
    pub name: String,
    /// Number of features per time step, if stated.
    pub dimensions: Option<usize>,
    /// Number of time steps of every series, if they have equal lengths.
    pub length: Option<usize>,
    /// Classes in order; `None` if series have none.
    pub classes: Option<Vec<String>>,
}

impl TsHeader {
    /// Parses a line that starts with `@`.
    pub(super) fn take(&mut self, line: &str) -> Result<(), String> {
        if !line.starts_with('@') {
            return Err("is not a header line, but @data is missing; the file is damaged".to_owned());
        }
        let mut words = line.split_whitespace();
        let key = words.next().unwrap_or_default().to_lowercase();
        let rest: Vec<&str> = words.collect();
        let first = rest.first().copied().unwrap_or_default();
        let boolean = |text: &str| match text.to_lowercase().as_str() {
            "true" => Ok(true),
            "false" => Ok(false),
            _ => Err(format!("has {text:.40?} instead of true or false")),
        };
        let whole = |most: usize| {
            let number = first.parse().ok().filter(|number| (1..=most).contains(number));
            number.map(Some).ok_or_else(|| format!("has {first:.40?} instead of a positive integer"))
        };
        match key.as_str() {
            "@problemname" => self.name = rest.join(" "),
            "@timestamps" => {
                if boolean(first)? {
                    return Err(
                        "has time stamps, which are not supported; write evenly spaced values".to_owned()
                    );
                }
            }
            "@univariate" => self.dimensions = if boolean(first)? { Some(1) } else { self.dimensions },
            "@dimensions" | "@dimension" => self.dimensions = whole(MAX_DIMENSIONS)?,
            "@serieslength" => self.length = whole(usize::MAX)?,
            "@classlabel" => {
                let named = rest.get(1..).unwrap_or_default().iter().map(|name| (*name).to_owned());
                self.classes = boolean(first)?.then(|| named.collect());
            }
            "@targetlabel" => {
                if boolean(first)? {
                    return Err(
                        "has target values for regression instead of classes, which is not supported"
                            .to_owned(),
                    );
                }
            }
            "@data" | "@missing" | "@equallength" => {}
            _ => return Err(format!("starts with {key:.40?}, which is not a key of .ts files")),
        }
        Ok(())
    }
}

/// Returns the label of a line, checked against the header.
pub(super) fn label(line: &str, header: Option<&TsHeader>) -> Result<Option<String>, String> {
    let Some(header) = header else {
        return Ok(fields(line).next().map(|label| whole_label(label.trim())));
    };
    let Some(classes) = &header.classes else { return Ok(None) };
    let (_, label) = line.rsplit_once(':').ok_or("has no class after a colon")?;
    let label = label.trim();
    if !classes.is_empty() && !classes.iter().any(|class| class == label) {
        return Err(format!("has class {label:.40?}; the classes of the header are {}", classes.join(", ")));
    }
    Ok(Some(label.to_owned()))
}

/// Returns `1` for `1.0000000e+00`; labels that are not integers are unchanged.
fn whole_label(label: &str) -> String {
    let whole = label.parse().ok().filter(|number: &f64| number.fract() == 0.0 && number.abs() < 1e15);
    whole.map_or_else(|| label.to_owned(), |number| (number as i64).to_string())
}

/// Returns the classes in order: of the header, otherwise by value if all are numbers, otherwise by name.
pub(super) fn classes<'a>(labels: impl Iterator<Item = &'a str>, header: Option<&TsHeader>) -> Classes {
    if let Some(named) = header.and_then(|header| header.classes.clone()).filter(|named| !named.is_empty()) {
        return named.into_iter().collect();
    }
    let mut sorted: Vec<&str> = labels.filter(|label| !label.is_empty()).collect();
    sorted.sort_unstable();
    let value = |label: &str| label.parse::<f64>().ok();
    if sorted.iter().all(|label| value(label).is_some()) {
        let number = |label: &str| value(label).unwrap_or(f64::NAN);
        sorted.sort_by(|a, b| number(a).total_cmp(&number(b)));
    }
    sorted.into_iter().collect()
}

/// Splits at tabs or commas or, if there are none, at blanks.
fn fields(line: &str) -> Box<dyn Iterator<Item = &str> + '_> {
    match line.chars().find(|mark| matches!(mark, ',' | '\t')) {
        Some(mark) => Box::new(line.trim_end_matches([mark, ' ']).split(mark)),
        None => Box::new(line.split_whitespace()),
    }
}

/// Returns whether a line is a label and at least two numbers.
pub(super) fn looks_like_series(line: &str) -> bool {
    let mut fields = fields(line.trim()).skip(1);
    let number = |field: Option<&str>| field.is_some_and(|field| field.trim().parse::<f64>().is_ok());
    number(fields.next()) && number(fields.next())
}

fn value(field: &str) -> Result<f32, String> {
    match field.trim() {
        "?" | "NaN" | "nan" | "" => Ok(f32::NAN),
        text => {
            text.parse().ok().filter(|number: &f32| number.is_finite()).ok_or_else(|| {
                format!("has {text:.40?} instead of a finite number or a missing value (?, NaN)")
            })
        }
    }
}

/// Parses label and series of a line of numbers. Missing values are NaN; those at the end are dropped.
///
/// # Errors
/// A message if the line is invalid.
pub fn series_from_line(line: &str) -> Result<(String, Timeseries), String> {
    let mut fields = fields(line.trim());
    let label = fields.next().unwrap_or_default().trim().to_owned();
    let mut values = fields.map(value).collect::<Result<Vec<_>, _>>()?;
    while values.last().is_some_and(|value| value.is_nan()) {
        values.pop();
    }
    let shape = [values.len(), 1];
    let series = Timeseries::new(values, shape).map_err(|_| "has a label and no value".to_owned())?;
    Ok((label, series))
}

/// Parses a line of a `.ts` file: features separated by colons, their values by commas; missing values are NaN.
///
/// # Errors
/// A message if the line is invalid.
pub fn series_from_ts_line(line: &str, header: &TsHeader) -> Result<Timeseries, String> {
    let line = line.trim();
    let features = match &header.classes {
        Some(_) => line.rsplit_once(':').ok_or("has no class after a colon")?.0,
        None => line,
    };
    let mut columns = Vec::new();
    for feature in features.split(':') {
        if columns.len() == MAX_DIMENSIONS {
            return Err(format!("has over {MAX_DIMENSIONS} features"));
        }
        columns.push(feature.split(',').map(value).collect::<Result<Vec<_>, _>>()?);
    }
    if header.dimensions.is_some_and(|dimensions| dimensions != columns.len()) {
        let expected = header.dimensions.unwrap_or_default();
        return Err(format!("has {} features, but the header states {expected}", columns.len()));
    }
    let length = columns.first().map_or(0, Vec::len);
    if let Some(other) = columns.iter().find(|column| column.len() != length) {
        return Err(format!(
            "has features of {length} and {} values; pad the shorter one with ?",
            other.len()
        ));
    }
    if header.length.is_some_and(|expected| expected != length) {
        return Err(format!(
            "has {length} values, but the header states {}",
            header.length.unwrap_or_default()
        ));
    }
    let time = |at: usize| columns.iter().filter_map(move |column| column.get(at).copied());
    let numbers: Vec<_> = (0..length).flat_map(time).collect();
    Timeseries::new(numbers, [length, columns.len()]).map_err(|error| error.to_string())
}
