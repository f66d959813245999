//! `opendr infer --dump DIR`: the tensors before and after each stage of an inference.
//!
//! Each item has a folder: its input as the learner receives it, the inputs and outputs of each run of a network, and the
//! predictions. `dump.json` lists the files in the order of processing, with shape, type, range and the number of values that
//! are not finite.

use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use opendr::data::PixelFormat;
use opendr::inference::recording::{self, RecordedTensor, Recording};
use opendr::inference::{TensorData, TensorInfo, TensorView};
use opendr::learner::Outputs;
use opendr::{Error, Result, ResultExt as _, ValueRef};
use serde::Serialize;
use serde_json::{Value as Json, json};

use crate::item::Item;

/// A folder of tensors that are written item by item.
pub struct Dump {
    folder: PathBuf,
    items: Vec<Entry>,
}

/// An item in `dump.json`.
#[derive(Serialize)]
struct Entry {
    input: String,
    index: u64,
    /// Folder of the files, relative to `dump.json`.
    folder: String,
    /// Runs of networks on the thread of the inference.
    runs: usize,
    files: Vec<Json>,
}

impl Dump {
    /// Creates a dump in `folder`, which must be missing or empty.
    ///
    /// # Errors
    /// `InvalidInput` when the folder has files, `Io` when it cannot be created.
    pub fn create(folder: &Path) -> Result<Self> {
        let failed = || format!("creating {}", folder.display());
        fs::create_dir_all(folder).context(failed)?;
        if fs::read_dir(folder).context(failed)?.next().is_some() {
            return Err(Error::invalid_input(format!(
                "{} is not empty; give --dump a new folder",
                folder.display()
            )));
        }
        let dump = Self { folder: folder.to_owned(), items: Vec::new() };
        dump.write_index()?;
        Ok(dump)
    }

    /// Runs an inference with all its tensors recorded; [`Self::write`] writes them.
    pub fn record<T>(infer: impl FnOnce() -> Result<T>) -> (Result<T>, Vec<Recording>) {
        recording::start_with_outputs();
        let result = infer();
        (result, recording::take())
    }

    /// Writes the files of an item and the index. After a failed inference there are no predictions, but the tensors up to
    /// the error.
    ///
    /// # Errors
    /// `Io` when a file cannot be written.
    pub fn write(&mut self, item: &Item, runs: &[Recording], outputs: Option<&[Outputs]>) -> Result<()> {
        let name = format!("{:06}", self.items.len());
        let folder = self.folder.join(&name);
        fs::create_dir_all(&folder).context(|| format!("creating {}", folder.display()))?;
        let mut files = vec![write_value(&folder, item.value())?];
        for (number, run) in runs.iter().enumerate() {
            let stages =
                [("input", &run.inputs, &run.tensors), ("output", &run.outputs, &run.output_tensors)];
            for (stage, infos, tensors) in stages {
                for (info, tensor) in infos.iter().zip(tensors) {
                    files.push(write_tensor(&folder, number, stage, info, tensor)?);
                }
            }
        }
        if let Some(outputs) = outputs {
            let predictions: Vec<Json> = outputs
                .iter()
                .map(|outputs| outputs.iter().map(|(name, value)| (name.to_owned(), json!(value))).collect())
                .collect();
            write_json(&folder.join("prediction.json"), &predictions)?;
            files.push(json!({"stage": "prediction", "file": "prediction.json"}));
        }
        self.items.push(Entry {
            input: item.path().display().to_string(),
            index: item.number(),
            folder: name,
            runs: runs.len(),
            files,
        });
        self.write_index()
    }

    /// Writes `dump.json` beside and then in place of the last one, so that Ctrl-C leaves a whole file.
    fn write_index(&self) -> Result<()> {
        let (partial, path) = (self.folder.join("dump.json.part"), self.folder.join("dump.json"));
        write_json(&partial, &json!({"schema": 1, "items": self.items}))?;
        fs::rename(&partial, &path).context(|| format!("writing {}", path.display()))
    }
}

/// Writes the input of an item: an image as RGB pixels, targets as JSON. Other data stay in the file that the index names.
fn write_value(folder: &Path, value: ValueRef<'_>) -> Result<Json> {
    let kind = value.value_type();
    if let ValueRef::Image(image) = value {
        let pixels = image.hwc_u8(PixelFormat::Rgb);
        let shape = [image.height(), image.width(), 3];
        let statistics = write_array(&folder.join("input.npy"), &TensorView::new(&shape, &pixels)?)?;
        return Ok(json!({
            "stage": "input",
            "file": "input.npy",
            "type": "u8",
            "format": "RGB",
            "shape": shape,
            "statistics": statistics,
        }));
    }
    if kind.is_target() {
        write_json(&folder.join("input.json"), &value)?;
        return Ok(json!({"stage": "input", "file": "input.json", "type": kind.name()}));
    }
    Ok(json!({"stage": "input", "type": kind.name()}))
}

fn write_tensor(
    folder: &Path,
    run: usize,
    stage: &str,
    info: &TensorInfo,
    tensor: &RecordedTensor,
) -> Result<Json> {
    // Names of tensors may have slashes and colons.
    let plain: String = info
        .name
        .chars()
        .map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' })
        .take(80)
        .collect();
    let file = format!("network-{run}-{stage}-{plain}.npy");
    let view = tensor.view()?;
    let statistics = write_array(&folder.join(&file), &view)?;
    Ok(json!({
        "stage": format!("network {stage}"),
        "run": run,
        "name": info.name,
        "file": file,
        "type": view.data().element_type().name(),
        "shape": view.shape(),
        "statistics": statistics,
    }))
}

/// Writes a tensor in NumPy's format, version 1.0, and returns its statistics.
fn write_array(path: &Path, tensor: &TensorView<'_>) -> Result<Json> {
    let failed = || format!("writing {}", path.display());
    let mut file = BufWriter::new(File::create(path).context(failed)?);
    let (descr, statistics) = match tensor.data() {
        TensorData::F32(data) => ("<f4", statistics(data.iter().map(|&value| f64::from(value)))),
        TensorData::I32(data) => ("<i4", statistics(data.iter().map(|&value| f64::from(value)))),
        TensorData::I64(data) => ("<i8", statistics(data.iter().map(|&value| value as f64))),
        TensorData::U8(data) => ("|u1", statistics(data.iter().map(|&value| f64::from(value)))),
        TensorData::I8(data) => ("|i1", statistics(data.iter().map(|&value| f64::from(value)))),
        TensorData::Bool(data) => ("|b1", statistics(data.iter().map(|&value| f64::from(u8::from(value))))),
        other => {
            return Err(Error::unsupported(format!("tensors of {} cannot be dumped", other.element_type())));
        }
    };
    let dims: String = tensor.shape().iter().map(|size| format!("{size}, ")).collect();
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({dims}), }}");
    // Magic, version, length and header are a multiple of 64 bytes.
    let padding = 63 - (10 + header.len()) % 64;
    header.extend(std::iter::repeat_n(' ', padding));
    header.push('\n');
    file.write_all(b"\x93NUMPY\x01\x00").context(failed)?;
    file.write_all(&(header.len() as u16).to_le_bytes()).context(failed)?;
    file.write_all(header.as_bytes()).context(failed)?;
    let written = match tensor.data() {
        TensorData::F32(data) => data.iter().try_for_each(|value| file.write_all(&value.to_le_bytes())),
        TensorData::I32(data) => data.iter().try_for_each(|value| file.write_all(&value.to_le_bytes())),
        TensorData::I64(data) => data.iter().try_for_each(|value| file.write_all(&value.to_le_bytes())),
        TensorData::U8(data) => file.write_all(data),
        TensorData::I8(data) => data.iter().try_for_each(|value| file.write_all(&value.to_le_bytes())),
        TensorData::Bool(data) => data.iter().try_for_each(|value| file.write_all(&[u8::from(*value)])),
        _ => Ok(()),
    };
    written.and_then(|()| file.flush()).context(failed)?;
    Ok(statistics)
}

/// Returns minimum, maximum and mean of the finite values, and the number of others.
fn statistics(values: impl Iterator<Item = f64>) -> Json {
    let (mut low, mut high, mut sum) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
    let (mut count, mut not_finite) = (0_u64, 0_u64);
    for value in values {
        if value.is_finite() {
            (low, high) = (low.min(value), high.max(value));
            sum += value;
            count += 1;
        } else {
            not_finite += 1;
        }
    }
    match count {
        0 => json!({"not_finite": not_finite}),
        _ => json!({"min": low, "max": high, "mean": sum / count as f64, "not_finite": not_finite}),
    }
}

fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value).map_err(|error| {
        Error::internal(format!("{} cannot be written as JSON", path.display())).with_source(error)
    })?;
    fs::write(path, text + "\n").context(|| format!("writing {}", path.display()))
}
