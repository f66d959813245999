//! The tables and descriptions in the folder `meta`.

use std::collections::BTreeSet;
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt as _};
use serde_json::{Map, Value};

use crate::record::{EpisodeRecord, VideoSegment};
use crate::table_writer::TableWriter;
use crate::{Column, FeatureStatistics, Info, Values};

/// Files per folder, and the sizes from which on a new file begins, in MB: LeRobot's defaults.
pub(crate) const CHUNK: usize = 1000;

/// Returns the columns of the table of episodes.
pub(crate) fn episode_columns(
    info: &Info,
    episodes: &[EpisodeRecord],
    file_of: &[usize],
) -> Vec<(String, Column)> {
    let integers = |of: &dyn Fn(usize, &EpisodeRecord) -> usize| {
        let values = episodes.iter().enumerate().map(|(at, record)| of(at, record) as i64);
        Column::scalars(Values::Int64(values.collect()))
    };
    let starts: Vec<usize> = episodes
        .iter()
        .scan(0, |end, record| {
            let start = *end;
            *end += record.length;
            Some(start)
        })
        .collect();
    let tasks = episodes.iter().flat_map(|record| record.tasks.iter().cloned()).collect();
    let mut columns = vec![
        ("episode_index".to_owned(), integers(&|at, _| at)),
        ("tasks".to_owned(), Column::lists(Values::Text(tasks), 1)),
        ("length".to_owned(), integers(&|_, record| record.length)),
        ("data/chunk_index".to_owned(), integers(&|at, _| file_of[at] / CHUNK)),
        ("data/file_index".to_owned(), integers(&|at, _| file_of[at] % CHUNK)),
        ("dataset_from_index".to_owned(), integers(&|at, _| starts[at])),
        ("dataset_to_index".to_owned(), integers(&|at, record| starts[at] + record.length)),
    ];
    for key in info.video_keys() {
        let times = |of: &dyn Fn(&VideoSegment) -> f64| {
            let values = episodes.iter().map(|record| record.videos.get(key).map_or(0.0, of));
            Column::scalars(Values::Float64(values.collect()))
        };
        columns.extend([
            (format!("videos/{key}/chunk_index"), integers(&|at, _| at / CHUNK)),
            (format!("videos/{key}/file_index"), integers(&|at, _| at % CHUNK)),
            (format!("videos/{key}/from_timestamp"), times(&|segment| segment.from)),
            (format!("videos/{key}/to_timestamp"), times(&|segment| segment.to)),
        ]);
    }
    let names: BTreeSet<_> = episodes.iter().flat_map(|record| record.statistics.keys()).collect();
    for name in names {
        let own = || episodes.iter().filter_map(|record| record.statistics.get(name));
        let empty = FeatureStatistics::default();
        for (at, (row, _)) in empty.rows().into_iter().enumerate() {
            let lengths = own().map(|statistics| statistics.rows()[at].1.len()).collect();
            let values = own().flat_map(|statistics| statistics.rows()[at].1.iter().copied());
            let column = Column { values: Values::Float64(values.collect()), lengths: Some(lengths) };
            columns.push((format!("stats/{name}/{row}"), column));
        }
        let counts = own().map(|statistics| statistics.count.first().map_or(0, |&count| count as i64));
        let counts = Column::lists(Values::Int64(counts.collect()), 1);
        columns.push((format!("stats/{name}/count"), counts));
    }
    columns.push(("meta/episodes/chunk_index".to_owned(), integers(&|_, _| 0)));
    columns.push(("meta/episodes/file_index".to_owned(), integers(&|_, _| 0)));
    columns
}

pub(crate) fn write_table(path: &Path, columns: &[(&str, &Column)], pandas: Option<String>) -> Result<()> {
    let mut table = TableWriter::create(path, columns, pandas)?;
    table.add(columns)?;
    table.finish()
}

pub(crate) fn write_json(path: &Path, value: &impl serde::Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| Error::internal("the description cannot be written as JSON").with_source(error))?;
    std::fs::write(path, text).context(|| path.display().to_string())
}

/// Returns what pandas stores about the table of tasks: tasks are the index of its rows.
pub(crate) fn tasks_index() -> Value {
    let column = |name: &str, pandas: &str, numpy: &str| {
        let mut column = Map::new();
        for (key, text) in
            [("name", name), ("field_name", name), ("pandas_type", pandas), ("numpy_type", numpy)]
        {
            column.insert(key.to_owned(), text.into());
        }
        column.insert("metadata".to_owned(), Value::Null);
        Value::Object(column)
    };
    serde_json::json!({
        "index_columns": ["task"],
        "column_indexes": [],
        "columns": [column("task_index", "int64", "int64"), column("task", "unicode", "object")],
        "creator": {"library": "opendr", "version": env!("CARGO_PKG_VERSION")},
        "pandas_version": "2.0.0",
    })
}
