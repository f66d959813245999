//! Columns of tables.

use opendr_engine::{Error, Result};

/// A column of a table: one value per row, or a list of values.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// The values of all rows, one after the other.
    pub values: Values,
    /// Values of each row; none for one per row that is no list.
    pub lengths: Option<Vec<usize>>,
}

/// Values of one type.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// `float32`.
    Float32(Vec<f32>),
    /// `float64`.
    Float64(Vec<f64>),
    /// `int64`, and shorter integers.
    Int64(Vec<i64>),
    /// `bool`.
    Bool(Vec<bool>),
    /// `string`.
    Text(Vec<String>),
}

impl Values {
    /// Returns the number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Float32(values) => values.len(),
            Self::Float64(values) => values.len(),
            Self::Int64(values) => values.len(),
            Self::Bool(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// Returns whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the name of the type in `info.json`.
    pub fn dtype(&self) -> &'static str {
        match self {
            Self::Float32(_) => "float32",
            Self::Float64(_) => "float64",
            Self::Int64(_) => "int64",
            Self::Bool(_) => "bool",
            Self::Text(_) => "string",
        }
    }

    /// Returns the values of a range.
    ///
    /// # Errors
    /// `Format` where the range is not within the values.
    fn slice(&self, range: std::ops::Range<usize>) -> Result<Self> {
        let outside = || {
            Error::format(format!(
                "values {range:?} of a column that has {}; the table is damaged",
                self.len()
            ))
        };
        Ok(match self {
            Self::Float32(values) => Self::Float32(values.get(range.clone()).ok_or_else(outside)?.to_vec()),
            Self::Float64(values) => Self::Float64(values.get(range.clone()).ok_or_else(outside)?.to_vec()),
            Self::Int64(values) => Self::Int64(values.get(range.clone()).ok_or_else(outside)?.to_vec()),
            Self::Bool(values) => Self::Bool(values.get(range.clone()).ok_or_else(outside)?.to_vec()),
            Self::Text(values) => Self::Text(values.get(range.clone()).ok_or_else(outside)?.to_vec()),
        })
    }
}

impl Column {
    /// Creates a column of one value per row.
    pub fn scalars(values: Values) -> Self {
        Self { values, lengths: None }
    }

    /// Creates a column of lists of `width` values.
    pub fn lists(values: Values, width: usize) -> Self {
        let rows = values.len().checked_div(width).unwrap_or(0);
        Self { values, lengths: Some(vec![width; rows]) }
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.lengths.as_ref().map_or(self.values.len(), Vec::len)
    }

    /// Returns the number of values that every row has.
    ///
    /// # Errors
    /// `Format` where rows differ, or have missing values.
    pub fn width(&self) -> Result<usize> {
        let Some(lengths) = &self.lengths else { return Ok(1) };
        let width = lengths.first().copied().unwrap_or(0);
        match lengths.iter().position(|&length| length != width) {
            None => Ok(width),
            Some(row) => Err(Error::format(format!(
                "row {row} has {} values, the first row {width}; the data set is damaged, or values are missing",
                lengths[row]
            ))),
        }
    }

    /// Returns the rows of a range.
    ///
    /// # Errors
    /// `Format` where the range is not within the column.
    pub fn slice(&self, rows: std::ops::Range<usize>) -> Result<Self> {
        let Some(lengths) = &self.lengths else { return Ok(Self::scalars(self.values.slice(rows)?)) };
        let own = lengths.get(rows.clone()).ok_or_else(|| {
            Error::format(format!(
                "rows {rows:?} of a column that has {}; the table is damaged",
                lengths.len()
            ))
        })?;
        let start = lengths[..rows.start].iter().sum::<usize>();
        let values = self.values.slice(start..start + own.iter().sum::<usize>())?;
        Ok(Self { values, lengths: Some(own.to_vec()) })
    }

    /// Returns the values as numbers.
    ///
    /// # Errors
    /// `Format` for text.
    pub fn numbers(&self) -> Result<Vec<f64>> {
        Ok(match &self.values {
            Values::Float32(values) => values.iter().map(|&x| f64::from(x)).collect(),
            Values::Float64(values) => values.clone(),
            Values::Int64(values) => values.iter().map(|&x| x as f64).collect(),
            Values::Bool(values) => values.iter().map(|&x| f64::from(u8::from(x))).collect(),
            Values::Text(_) => return Err(Error::format("a column of text, where one of numbers is needed")),
        })
    }

    /// Returns one integer per row.
    ///
    /// # Errors
    /// `Format` for other columns, and for an integer below zero.
    pub fn counts(&self) -> Result<Vec<usize>> {
        match (&self.values, &self.lengths) {
            (Values::Int64(values), None) => {
                let count = |&value: &i64| {
                    usize::try_from(value)
                        .map_err(|_| Error::format(format!("{value} is no index; the data set is damaged")))
                };
                values.iter().map(count).collect()
            }
            _ => Err(Error::format(format!(
                "a column of {}, where one integer per row is needed",
                self.values.dtype()
            ))),
        }
    }
}
