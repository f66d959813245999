//! Weights by name.

use std::collections::HashSet;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use burn::module::Module;
use opendr_engine::{Error, Result, ResultExt};
use opendr_import::SafetensorsFile;
use opendr_onnx::FloatType;

use crate::weights::fill::fill;
use crate::weights::slot::slots;
use crate::weights::{Report, Rules, names, onnx, order, pytorch, safetensors};

/// Maximum size in bytes of a file, and of a table as 32-bit floats.
const MAX_BYTES: u64 = 2 << 30;

/// Maximum number of axes of a weight.
const MAX_AXES: usize = 8;

/// A named weight.
#[derive(Debug, Clone, PartialEq)]
pub struct Weight {
    pub(super) name: String,
    pub(super) shape: Vec<usize>,
    pub(super) values: Vec<f32>,
}

impl Weight {
    /// Returns the name, with dots between the parts, e.g. `features.0.weight`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the shape: `[outputs, inputs / groups, height, width]` for a convolution, `[outputs, inputs]` for a linear
    /// layer.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Returns the values, row-major.
    pub fn values(&self) -> &[f32] {
        &self.values
    }
}

/// Weights of a file, in one form for all formats: 32-bit floats, PyTorch's layout, names of parameters (`LAYER.weight`,
/// `LAYER.bias`, `LAYER.running_mean`, `LAYER.running_var`).
///
/// Weights of an ONNX model are in the order of its graph, others sorted by name (numbers by their value).
#[derive(Debug, Clone, Default)]
pub struct WeightTable {
    weights: Vec<Weight>,
    names: HashSet<String>,
    numbers: usize,
}

impl WeightTable {
    /// Reads a file of weights, whose format is detected from its content: safetensors, PyTorch's `.pth` or `.pt` (nothing in
    /// it is executed), ONNX (quantised integers become floats).
    ///
    /// # Errors
    /// `NotFound` or `Io` when the file cannot be read; `Format` for another format or a damaged file; `Unsupported` for a file
    /// that is too large or too old. All errors contain the path.
    pub fn from_file(path: &Path) -> Result<Self> {
        read(path).context(|| format!("reading weights from {}", path.display()))
    }

    /// Like [`WeightTable::from_file`], for the content of a safetensors or ONNX file.
    ///
    /// # Errors
    /// As [`WeightTable::from_file`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        match Kind::of(bytes) {
            Kind::Safetensors => safetensors::table_from_safetensors(bytes),
            Kind::Onnx => onnx::table_from_onnx(bytes),
            Kind::Tar => Err(too_old()),
            Kind::Pytorch => {
                Err(Error::unsupported("PyTorch checkpoints can only be read from files, not from memory"))
            }
        }
    }

    /// Returns the weights.
    pub fn weights(&self) -> &[Weight] {
        &self.weights
    }

    /// Returns the weight `name`.
    pub fn get(&self, name: &str) -> Option<&Weight> {
        self.weights.iter().find(|weight| weight.name == name)
    }

    /// Whether the table contains the weight `name`.
    pub fn has(&self, name: &str) -> bool {
        self.names.contains(name)
    }

    /// Appends a weight.
    ///
    /// # Errors
    /// `Format` when the shape does not match the number of values or the name exists already, `Unsupported` when the table
    /// becomes too large.
    pub fn add(&mut self, name: impl Into<String>, shape: Vec<usize>, values: Vec<f32>) -> Result<()> {
        let name = name.into();
        if opendr_onnx::element_count(&shape) != Some(values.len()) || shape.len() > MAX_AXES {
            return Err(Error::format(format!(
                "weight {name:.80?} has shape {shape:?} but {} values",
                values.len()
            )));
        }
        self.numbers = Self::checked_numbers(self.numbers, values.len(), &name)?;
        if !self.names.insert(name.clone()) {
            return Err(Error::format(format!("the file has two weights {name:.80?}")));
        }
        self.weights.push(Weight { name, shape, values });
        Ok(())
    }

    /// Like [`WeightTable::add`], for values as stored in a file.
    pub(super) fn add_elements(
        &mut self,
        name: String,
        shape: Vec<usize>,
        element: FloatType,
        bytes: &[u8],
    ) -> Result<()> {
        Self::checked_numbers(self.numbers, bytes.len() / element.bytes(), &name)?;
        self.add(name, shape, element.decode(bytes))
    }

    /// Returns the new total when `more` values fit beside `numbers`; to be called before they are read.
    pub(super) fn checked_numbers(numbers: usize, more: usize, name: &str) -> Result<usize> {
        let sum = numbers.checked_add(more).filter(|sum| *sum as u64 * 4 <= MAX_BYTES);
        sum.ok_or_else(|| {
            Error::unsupported(format!(
                "with {name:.80?} of {more} values the weights exceed {} MB",
                MAX_BYTES >> 20
            ))
        })
    }

    /// Loads the weights into `module`, which stays on its device; parameters without a weight are unchanged.
    ///
    /// By name, a weight of another shape (such as a head for other classes) is skipped and listed in the report; by order, it
    /// is an error.
    ///
    /// # Errors
    /// `InvalidParam` for contradictory rules, `InvalidInput` when the layers in order do not match the module's.
    pub fn apply<M: Module>(&self, module: M, rules: &Rules) -> Result<(M, Report)> {
        let slots = slots(&module, rules);
        let (plan, report) = match rules.is_by_order() {
            true => order::plan(&slots, self, rules)?,
            false => names::plan(&slots, self, rules)?,
        };
        Ok((fill(module, plan), report))
    }
}

/// Format of a file of weights.
enum Kind {
    Safetensors,
    Pytorch,
    Tar,
    Onnx,
}

impl Kind {
    fn of(head: &[u8]) -> Self {
        if SafetensorsFile::is_start(head) {
            return Self::Safetensors;
        }
        match head {
            [b'P', b'K', 3, 4, ..] | [0x80, 0..=5, ..] => Self::Pytorch,
            _ if head.get(257..262) == Some(b"ustar") => Self::Tar,
            _ => Self::Onnx,
        }
    }
}

fn read(path: &Path) -> Result<WeightTable> {
    let mut file = File::open(path)?;
    let size = file.metadata()?.len();
    if size > MAX_BYTES {
        return Err(Error::unsupported(format!(
            "the file has {} MB; at most {} MB are supported",
            size >> 20,
            MAX_BYTES >> 20
        )));
    }
    let mut bytes = Vec::new();
    file.by_ref().take(512).read_to_end(&mut bytes)?;
    if matches!(Kind::of(&bytes), Kind::Pytorch) {
        return pytorch::table_from_pytorch(path);
    }
    file.take(MAX_BYTES).read_to_end(&mut bytes)?;
    WeightTable::from_bytes(&bytes)
}

fn too_old() -> Error {
    Error::unsupported("the checkpoint is of PyTorch before 0.1.10; save it again with a current PyTorch")
}
