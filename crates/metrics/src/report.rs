//! What an evaluation ends in.

use opendr_engine::Statistics;
use serde::{Deserialize, Serialize};

/// Numbers, tables, and figures to draw.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The metric's numbers, main one first in [`Report::headline`].
    #[serde(flatten)]
    pub statistics: Statistics,
    /// The key of the number to quote, to rank by, and to stop a training by.
    pub headline: String,
    /// Numbers by class, by range, by sequence.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tables: Vec<Table>,
    /// What people would look at.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub figures: Vec<Figure>,
}

impl Report {
    /// An empty report whose number to quote will be `headline`.
    pub fn new(headline: &str) -> Self {
        Self { headline: headline.to_owned(), ..Self::default() }
    }
}

/// Numbers in rows.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// What the rows are, e.g. `"class"`.
    pub name: String,
    /// What the columns are.
    pub columns: Vec<String>,
    /// Label and numbers of each row; `None` where there is none.
    pub rows: Vec<(String, Vec<Option<f64>>)>,
}

/// Something to draw.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Figure {
    /// Lines over two axes.
    Curves(Curves),
    /// Counts of truth by answer.
    Matrix(Matrix),
    /// One number for each of several things.
    Bars(Bars),
}

/// One number, from 0, for each of several things.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Bars {
    /// Of the file, e.g. `"importance"`.
    pub name: String,
    /// For people.
    pub title: String,
    /// What the numbers are.
    pub x: String,
    /// What each is of, and it.
    pub bars: Vec<(String, f64)>,
}

/// Lines over two axes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Curves {
    /// Of the file, e.g. `"precision_recall"`.
    pub name: String,
    /// For people.
    pub title: String,
    /// The horizontal axis.
    pub x: String,
    /// The vertical axis.
    pub y: String,
    /// The lines.
    pub lines: Vec<Line>,
}

/// One line.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// For the legend.
    pub label: String,
    /// `[x, y]`.
    pub points: Vec<[f64; 2]>,
}

/// A confusion matrix.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Matrix {
    /// Of the file, e.g. `"confusion"`.
    pub name: String,
    /// For people.
    pub title: String,
    /// Of rows (truth) and columns (answer).
    pub labels: Vec<String>,
    /// Counts, row by row, `labels.len()` squared.
    pub counts: Vec<u64>,
}
