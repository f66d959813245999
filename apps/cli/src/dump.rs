//! `opendr infer --dump DIR`: the tensors before and after each stage of an inference.
//!
//! Each item has a folder: its input as the learner receives it, the inputs and outputs of each run of a network, and the
//! predictions. `dump.json` lists the files in the order of processing, with shape, type, range and the number of values that
//! are not finite.

use std::fs;
use std::path::{Path, PathBuf};

use opendr::atomic_file::replace_file;
use opendr::data::PixelFormat;
use opendr::datasets::{NpyElement, npy_from_values};
use opendr::inference::recording::{self, RecordedTensor, Recording};
use opendr::inference::{TensorData, TensorInfo, TensorView};
use opendr::learner::Outputs;
use opendr::{Error, JsonFormat, Result, ResultExt as _, ValueRef};
use serde::Serialize;
use serde_json::{Value as Json, json};

use crate::item::Item;

/// Format of `dump.json`.
const FORMAT: JsonFormat = JsonFormat::new("index of a dump", 1);

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

    /// Replaces `dump.json` as a whole, so that Ctrl-C leaves a complete file.
    fn write_index(&self) -> Result<()> {
        let path = self.folder.join("dump.json");
        replace_file(&path, FORMAT.to_pretty_json(&json!({"items": self.items}))?.as_bytes())
    }
}

/// Writes the input of an item: an image as RGB pixels, targets as JSON. Other data stay in the file that the index names.
fn write_value(folder: &Path, value: ValueRef<'_>) -> Result<Json> {
    let kind = value.value_type();
    if let ValueRef::Image(image) = value {
        let pixels = image.hwc_u8(PixelFormat::Rgb);
        let shape = [image.height(), image.width(), 3];
        let statistics = write_array(&folder.join("input.npy"), &pixels, &shape, f64::from)?;
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
    let statistics = write_tensor_file(&folder.join(&file), &view)?;
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

/// Writes a tensor in NumPy's format and returns its statistics.
fn write_tensor_file(path: &Path, tensor: &TensorView<'_>) -> Result<Json> {
    let shape = tensor.shape();
    match tensor.data() {
        TensorData::F32(values) => write_array(path, values, shape, f64::from),
        TensorData::I32(values) => write_array(path, values, shape, f64::from),
        TensorData::I64(values) => write_array(path, values, shape, |value| value as f64),
        TensorData::U8(values) => write_array(path, values, shape, f64::from),
        TensorData::I8(values) => write_array(path, values, shape, f64::from),
        TensorData::Bool(values) => write_array(path, values, shape, f64::from),
        other => Err(Error::unsupported(format!("tensors of {} cannot be dumped", other.element_type()))),
    }
}

fn write_array<T: NpyElement>(
    path: &Path,
    values: &[T],
    shape: &[usize],
    number: fn(T) -> f64,
) -> Result<Json> {
    fs::write(path, npy_from_values(values, shape)?).context(|| format!("writing {}", path.display()))?;
    Ok(statistics(values.iter().map(|value| number(*value))))
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
    fs::write(path, json_text(path, value)?).context(|| format!("writing {}", path.display()))
}

fn json_text(path: &Path, value: &impl Serialize) -> Result<String> {
    let text = serde_json::to_string_pretty(value).map_err(|error| {
        Error::internal(format!("{} cannot be written as JSON", path.display())).with_source(error)
    })?;
    Ok(text + "\n")
}
