//! Reports of metrics.

use opendr_engine::Statistics;
use serde::{Deserialize, Serialize};

/// The result of a metric: numbers, tables, and figures to draw.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Numbers of the metric; [`Report::headline`] is the key of the main one.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// Key of the main number, for ranking and early stopping.
    pub headline: String,
    /// Tables of numbers by class, range or sequence.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tables: Vec<Table>,
    /// Figures.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub figures: Vec<Figure>,
}

impl Report {
    /// Creates an empty report with the key of its main number.
    pub fn new(headline: &str) -> Self {
        Self { headline: headline.to_owned(), ..Self::default() }
    }
}

/// A table of numbers.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Kind of the rows, e.g. `"class"`.
    pub name: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Label and numbers of each row; `None` if undefined.
    pub rows: Vec<(String, Vec<Option<f64>>)>,
}

/// A figure to draw.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Figure {
    /// A line chart.
    Curves(Curves),
    /// A confusion matrix.
    Matrix(Matrix),
    /// A bar chart.
    Bars(Bars),
}

/// A bar chart, with bars from 0.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Bars {
    /// File name, e.g. `"importance"`.
    pub name: String,
    /// Title.
    pub title: String,
    /// Label of the axis of the numbers.
    pub x: String,
    /// Label and number of each bar.
    pub bars: Vec<(String, f64)>,
}

/// A line chart.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Curves {
    /// File name, e.g. `"precision_recall"`.
    pub name: String,
    /// Title.
    pub title: String,
    /// Label of the horizontal axis.
    pub x: String,
    /// Label of the vertical axis.
    pub y: String,
    /// Lines.
    pub lines: Vec<Line>,
}

/// A line of a line chart.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Label in the legend.
    pub label: String,
    /// Points `[x, y]`.
    pub points: Vec<[f64; 2]>,
}

/// A confusion matrix.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Matrix {
    /// File name, e.g. `"confusion"`.
    pub name: String,
    /// Title.
    pub title: String,
    /// Labels of rows (ground truth) and columns (predictions).
    pub labels: Vec<String>,
    /// Counts, row by row, `labels.len()` squared.
    pub counts: Vec<u64>,
}
