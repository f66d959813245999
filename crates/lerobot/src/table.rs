//! Reading of Parquet tables.

use std::collections::BTreeMap;
use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt as _};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;
use parquet::file::reader::{ChunkReader, FileReader as _, SerializedFileReader};

use crate::{Column, Values};

/// Columns by name.
pub type Table = BTreeMap<String, Column>;

/// Maximum values of a column, and bytes of a decompressed one.
const MOST_VALUES: i64 = 1 << 28;
const MOST_BYTES: i64 = 1 << 31;

/// Reads the columns of a file whose names are `wanted`. Columns of structures (pictures) are left out.
///
/// # Errors
/// `NotFound` and `Io`; `Format` for a damaged table.
pub(crate) fn read_table(path: &Path, wanted: &dyn Fn(&str) -> bool) -> Result<Table> {
    let file = File::open(path).context(|| path.display().to_string())?;
    read_columns(file, wanted).context(|| path.display().to_string())
}

/// Reads a table from its bytes or file. The decoder is one of another project: where a damaged file makes it panic, that is an error too.
pub(crate) fn read_columns(
    source: impl ChunkReader + 'static,
    wanted: &dyn Fn(&str) -> bool,
) -> Result<Table> {
    let read = catch_unwind(AssertUnwindSafe(|| decode(source, wanted)));
    read.unwrap_or_else(|_| Err(Error::format("the Parquet table is damaged; download the data set again")))
}

fn damaged(error: ParquetError) -> Error {
    Error::format("the Parquet table cannot be read; download the data set again").with_source(error)
}

fn decode(source: impl ChunkReader + 'static, wanted: &dyn Fn(&str) -> bool) -> Result<Table> {
    let reader = SerializedFileReader::new(source).map_err(damaged)?;
    let mut table = Table::new();
    for group in 0..reader.num_row_groups() {
        let rows = reader.get_row_group(group).map_err(damaged)?;
        for index in 0..rows.num_columns() {
            let chunk = rows.metadata().column(index);
            let parts = chunk.column_path().parts();
            let Some(name) = parts.first().filter(|name| wanted(name)) else { continue };
            let descriptor = chunk.column_descr();
            let is_list = descriptor.max_rep_level() > 0;
            if !is_list && parts.len() > 1 {
                continue;
            }
            if !(0..=MOST_VALUES).contains(&chunk.num_values())
                || !(0..=MOST_BYTES).contains(&chunk.uncompressed_size())
            {
                return Err(Error::format(format!(
                    "column {name:.80?} states {} values of {} bytes, which is too large",
                    chunk.num_values(),
                    chunk.uncompressed_size()
                )));
            }
            let most = descriptor.max_def_level();
            let column = rows.get_column_reader(index).map_err(damaged)?;
            let column = column_of(column, is_list, most).context(|| format!("column {name:.80?}"))?;
            match table.get_mut(name) {
                None => drop(table.insert(name.clone(), column)),
                Some(first) => append(first, column)?,
            }
        }
    }
    Ok(table)
}

fn column_of(reader: ColumnReader, is_list: bool, most: i16) -> Result<Column> {
    let (values, lengths) = match reader {
        ColumnReader::FloatColumnReader(reader) => wrap(read(reader, most)?, Values::Float32),
        ColumnReader::DoubleColumnReader(reader) => wrap(read(reader, most)?, Values::Float64),
        ColumnReader::Int64ColumnReader(reader) => wrap(read(reader, most)?, Values::Int64),
        ColumnReader::Int32ColumnReader(reader) => wrap(read(reader, most)?, |values: Vec<i32>| {
            Values::Int64(values.into_iter().map(i64::from).collect())
        }),
        ColumnReader::BoolColumnReader(reader) => wrap(read(reader, most)?, Values::Bool),
        ColumnReader::ByteArrayColumnReader(reader) => {
            let (values, lengths): (Vec<ByteArray>, _) = read(reader, most)?;
            let text = |value: ByteArray| {
                value.as_utf8().map(str::to_owned).map_err(|_| Error::format("text that is not UTF-8"))
            };
            (Values::Text(values.into_iter().map(text).collect::<Result<_>>()?), lengths)
        }
        _ => return Err(Error::unsupported("values of 96 bits or fixed bytes; leave the feature out")),
    };
    match is_list {
        true => Ok(Column { values, lengths: Some(lengths) }),
        false if values.len() == lengths.len() => Ok(Column::scalars(values)),
        false => Err(Error::format(format!(
            "{} of {} rows have no value; fill them, or leave the feature out",
            lengths.len() - values.len(),
            lengths.len()
        ))),
    }
}

fn wrap<T>((values, lengths): (Vec<T>, Vec<usize>), of: impl Fn(Vec<T>) -> Values) -> (Values, Vec<usize>) {
    (of(values), lengths)
}

/// Returns all values of a column, and the number of values of each row.
fn read<T: DataType>(mut reader: ColumnReaderImpl<T>, most: i16) -> Result<(Vec<T::T>, Vec<usize>)> {
    const RECORDS: usize = 1 << 14;
    let (mut values, mut definitions, mut repetitions) = (Vec::new(), Vec::new(), Vec::new());
    let (mut lengths, mut rows) = (Vec::new(), 0);
    loop {
        definitions.clear();
        repetitions.clear();
        let read = reader.read_records(RECORDS, Some(&mut definitions), Some(&mut repetitions), &mut values);
        let (records, stored, levels) = read.map_err(damaged)?;
        if records == 0 && levels == 0 {
            return Ok((values, lengths));
        }
        rows += records;
        if definitions.is_empty() && repetitions.is_empty() {
            // All values are present, one per row.
            lengths.resize(lengths.len() + stored, 1);
            continue;
        }
        for at in 0..levels {
            let begins = repetitions.get(at).is_none_or(|&level| level == 0);
            let present = definitions.get(at).is_none_or(|&level| level == most);
            match lengths.last_mut() {
                Some(length) if !begins => *length += usize::from(present),
                None if !begins => return Err(Error::format("the first row begins within a list")),
                _ => lengths.push(usize::from(present)),
            }
        }
        if lengths.len() != rows {
            return Err(Error::format("the rows of a list column do not match its levels"));
        }
    }
}

/// Appends the rows of a further row group.
fn append(column: &mut Column, further: Column) -> Result<()> {
    match (&mut column.values, further.values) {
        (Values::Float32(own), Values::Float32(other)) => own.extend(other),
        (Values::Float64(own), Values::Float64(other)) => own.extend(other),
        (Values::Int64(own), Values::Int64(other)) => own.extend(other),
        (Values::Bool(own), Values::Bool(other)) => own.extend(other),
        (Values::Text(own), Values::Text(other)) => own.extend(other),
        _ => return Err(Error::format("a column has several types")),
    }
    if let (Some(own), Some(other)) = (&mut column.lengths, further.lengths) {
        own.extend(other);
    }
    Ok(())
}

/// Reads a table from bytes and returns its number of columns: for fuzzing.
///
/// # Errors
/// `Format` for a damaged table.
pub fn columns_of_bytes(bytes: Vec<u8>) -> Result<usize> {
    read_columns(bytes::Bytes::from(bytes), &|_| true).map(|table| table.len())
}
