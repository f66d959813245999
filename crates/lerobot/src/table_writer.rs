//! Writing of Parquet tables.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use opendr_engine::{Error, Result, ResultExt as _};
use parquet::basic::{Compression, ConvertedType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};

use crate::{Column, Values};

/// A table that grows by groups of rows; the file is complete after [`Self::finish`].
pub(crate) struct TableWriter {
    path: PathBuf,
    writer: SerializedFileWriter<File>,
}

/// Definition levels of a value in a list, and of one that is no list; an empty list.
const IN_LIST: i16 = 3;
const PRESENT: i16 = 1;
const EMPTY: i16 = 1;

impl TableWriter {
    /// Creates a file for rows as those of `columns`. `pandas` is its description of the index, if there is one.
    ///
    /// # Errors
    /// `Io` where the file cannot be written.
    pub fn create(path: &Path, columns: &[(&str, &Column)], pandas: Option<String>) -> Result<Self> {
        let unwritable = |error| unwritable(path, error);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).context(|| folder.display().to_string())?;
        }
        let file = File::create(path).context(|| path.display().to_string())?;
        let fields = columns.iter().map(|(name, column)| field(name, column).map(Arc::new));
        let fields = fields.collect::<Result<Vec<TypePtr>, _>>().map_err(unwritable)?;
        let schema = Type::group_type_builder("schema").with_fields(fields).build().map_err(unwritable)?;
        let metadata = pandas.map(|text| vec![KeyValue::new("pandas".to_owned(), text)]);
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(metadata)
            .build();
        let writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties));
        Ok(Self { path: path.to_owned(), writer: writer.map_err(unwritable)? })
    }

    /// Returns the bytes that were written.
    pub fn bytes(&self) -> u64 {
        self.writer.bytes_written() as u64
    }

    /// Adds the rows of columns in the order of [`Self::create`].
    ///
    /// # Errors
    /// `Io`, and `Internal` for columns of other types.
    pub fn add(&mut self, columns: &[(&str, &Column)]) -> Result<()> {
        let group = self.writer.next_row_group().map_err(|error| unwritable(&self.path, error))?;
        write_group(group, columns).map_err(|error| unwritable(&self.path, error))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// `Io`.
    pub fn finish(self) -> Result<()> {
        self.writer.close().map(drop).map_err(|error| unwritable(&self.path, error))
    }
}

fn unwritable(path: &Path, error: ParquetError) -> Error {
    Error::io(format!("writing {}; free space on the disk", path.display())).with_source(error)
}

/// Returns the type of a column, as Arrow writes it.
fn field(name: &str, column: &Column) -> Result<Type, ParquetError> {
    let value = |name: &str| {
        let (physical, converted) = match column.values {
            Values::Float32(_) => (Physical::FLOAT, ConvertedType::NONE),
            Values::Float64(_) => (Physical::DOUBLE, ConvertedType::NONE),
            Values::Int64(_) => (Physical::INT64, ConvertedType::NONE),
            Values::Bool(_) => (Physical::BOOLEAN, ConvertedType::NONE),
            Values::Text(_) => (Physical::BYTE_ARRAY, ConvertedType::UTF8),
        };
        Type::primitive_type_builder(name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_converted_type(converted)
            .build()
    };
    if column.lengths.is_none() {
        return value(name);
    }
    let repeated = Type::group_type_builder("list")
        .with_repetition(Repetition::REPEATED)
        .with_fields(vec![Arc::new(value("element")?)])
        .build()?;
    Type::group_type_builder(name)
        .with_repetition(Repetition::OPTIONAL)
        .with_converted_type(ConvertedType::LIST)
        .with_fields(vec![Arc::new(repeated)])
        .build()
}

fn write_group(
    mut group: SerializedRowGroupWriter<'_, File>,
    columns: &[(&str, &Column)],
) -> Result<(), ParquetError> {
    for (_, column) in columns {
        match &column.values {
            Values::Float32(values) => write::<FloatType>(&mut group, values, column)?,
            Values::Float64(values) => write::<DoubleType>(&mut group, values, column)?,
            Values::Int64(values) => write::<Int64Type>(&mut group, values, column)?,
            Values::Bool(values) => write::<BoolType>(&mut group, values, column)?,
            Values::Text(values) => {
                let values: Vec<_> = values.iter().map(|text| ByteArray::from(text.as_str())).collect();
                write::<ByteArrayType>(&mut group, &values, column)?;
            }
        }
    }
    group.close().map(drop)
}

fn write<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, File>,
    values: &[T::T],
    column: &Column,
) -> Result<(), ParquetError> {
    let Some(mut writer) = group.next_column()? else {
        return Err(ParquetError::General("more columns than the table has".to_owned()));
    };
    let (mut definitions, mut repetitions) = (Vec::new(), Vec::new());
    match &column.lengths {
        None => definitions.resize(values.len(), PRESENT),
        Some(lengths) => {
            for &length in lengths {
                definitions.resize(definitions.len() + length, IN_LIST);
                repetitions.push(0);
                match length {
                    0 => definitions.push(EMPTY),
                    _ => repetitions.resize(repetitions.len() + length - 1, 1),
                }
            }
        }
    }
    let repetitions = column.lengths.as_ref().map(|_| &repetitions[..]);
    writer.typed::<T>().write_batch(values, Some(&definitions), repetitions)?;
    writer.close()
}
