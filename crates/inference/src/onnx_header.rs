//! Validation of an ONNX model before a runtime opens it.
//!
//! Runtimes respond to a damaged or hostile file with anything from a vague message to an aborted process. The
//! structure is therefore checked here: complete fields, weights with as many elements as their shape, no references
//! to other files.

use std::collections::HashSet;

use opendr_engine::{Error, Result};

use crate::protobuf::{Fields, Value};
use crate::tensor::{ElementType, MAX_RANK, TensorInfo};

/// Maximum nesting depth of graphs within a model (branches and loop bodies).
const MAX_DEPTH: usize = 16;

/// Declared inputs and outputs of a model.
pub(crate) struct OnnxHeader {
    pub(crate) inputs: Vec<TensorInfo>,
    pub(crate) outputs: Vec<TensorInfo>,
}

/// Returns the inputs and the outputs that an ONNX model declares; inputs with an initialiser are none.
///
/// # Errors
/// `Format` when the bytes are not a complete ONNX model, `Unsupported` when it keeps weights in other files or when an input or
/// output has a type that [`ElementType`] lacks.
pub fn declared_tensors(onnx: &[u8]) -> Result<[Vec<TensorInfo>; 2]> {
    OnnxHeader::read(onnx).map(|header| [header.inputs, header.outputs])
}

impl OnnxHeader {
    /// Reads and checks the structure of a model.
    ///
    /// # Errors
    /// `Format` when the bytes are not a complete ONNX model, `Unsupported` when it keeps weights in other files or
    /// when an input or output has a type that [`ElementType`] lacks.
    pub(crate) fn read(model: &[u8]) -> Result<Self> {
        let mut graph = None;
        for field in Fields::new(model) {
            let field = field?;
            if let (7, Value::Bytes(bytes)) = (field.number, field.value) {
                graph = Some(bytes);
            }
        }
        let graph = graph.ok_or_else(|| Error::format("not an ONNX model: it has no graph"))?;
        let mut initialised = HashSet::new();
        let (mut inputs, mut outputs) = (Vec::new(), Vec::new());
        for field in Fields::new(graph) {
            let field = field?;
            match (field.number, field.value) {
                (1, Value::Bytes(node)) => check_node(node, 0)?,
                (5, Value::Bytes(tensor)) => {
                    initialised.insert(check_tensor(tensor)?);
                }
                (11, Value::Bytes(info)) => inputs.push(info),
                (12, Value::Bytes(info)) => outputs.push(info),
                _ => {}
            }
        }
        let read_all = |infos: Vec<&[u8]>| -> Result<Vec<TensorInfo>> {
            infos
                .into_iter()
                .map(ValueInfo::read)
                .filter(|info| !info.as_ref().is_ok_and(|info| initialised.contains(info.name)))
                .map(|info| info?.tensor_info())
                .collect()
        };
        let header = Self { inputs: read_all(inputs)?, outputs: read_all(outputs)? };
        if header.outputs.is_empty() {
            return Err(Error::format("the ONNX model has no output"));
        }
        Ok(header)
    }
}

fn check_graph(graph: &[u8], depth: usize) -> Result<()> {
    if depth > MAX_DEPTH {
        return Err(Error::format(format!("the ONNX model nests graphs deeper than {MAX_DEPTH} levels")));
    }
    for field in Fields::new(graph) {
        let field = field?;
        match (field.number, field.value) {
            (1, Value::Bytes(node)) => check_node(node, depth)?,
            (5, Value::Bytes(tensor)) => _ = check_tensor(tensor)?,
            _ => {}
        }
    }
    Ok(())
}

fn check_node(node: &[u8], depth: usize) -> Result<()> {
    for field in Fields::new(node) {
        let field = field?;
        let (5, Value::Bytes(attribute)) = (field.number, field.value) else { continue };
        for field in Fields::new(attribute) {
            let field = field?;
            match (field.number, field.value) {
                (5 | 10, Value::Bytes(tensor)) => _ = check_tensor(tensor)?,
                (6 | 11, Value::Bytes(graph)) => check_graph(graph, depth + 1)?,
                _ => {}
            }
        }
    }
    Ok(())
}

/// Checks that a tensor contains its elements, and returns its name.
fn check_tensor(tensor: &[u8]) -> Result<&str> {
    let (mut name, mut data_type, mut raw) = ("", 0, None);
    let mut count = Some(1_u64);
    let mut external = false;
    for field in Fields::new(tensor) {
        let field = field?;
        match (field.number, field.value) {
            (1, Value::Varint(dim)) => count = count.and_then(|count| count.checked_mul(dim)),
            (1, Value::Bytes(packed)) => {
                let mut dims = Fields::new(packed);
                while let Some(dim) = dims.varint() {
                    count = count.and_then(|count| count.checked_mul(dim));
                }
            }
            (2, Value::Varint(value)) => data_type = value,
            (8, Value::Bytes(bytes)) => name = text(bytes)?,
            (9, Value::Bytes(bytes)) => raw = Some(bytes),
            (13, _) => external = true,
            (14, Value::Varint(location)) => external |= location != 0,
            _ => {}
        }
    }
    if external {
        return Err(Error::unsupported(format!(
            "the ONNX model keeps its weights {name:?} in another file; save it as one file"
        )));
    }
    let wanted = element_bytes(data_type).and_then(|size| count?.checked_mul(size));
    let fits = match (raw, element_bytes(data_type)) {
        (Some(raw), Some(_)) => wanted == u64::try_from(raw.len()).ok(),
        (Some(_), None) => true,
        // Elements in typed fields take at least a byte each.
        (None, _) => count.is_some_and(|count| count <= tensor.len() as u64),
    };
    if !fits {
        return Err(Error::format(format!(
            "damaged ONNX model: the size of the weights {name:?} does not match their shape; copy or download the file again"
        )));
    }
    Ok(name)
}

/// Returns the bytes per element in a tensor's raw data, for types of whole bytes.
fn element_bytes(data_type: u64) -> Option<u64> {
    match data_type {
        2 | 3 | 9 => Some(1),
        4 | 5 | 10 | 16 => Some(2),
        1 | 6 | 12 => Some(4),
        7 | 11 | 13 => Some(8),
        _ => None,
    }
}

fn text(bytes: &[u8]) -> Result<&str> {
    std::str::from_utf8(bytes).map_err(|_| Error::format("damaged ONNX model: a name is not UTF-8"))
}

/// A declared input or output whose type is not yet checked (one with an initializer may have any type).
struct ValueInfo<'a> {
    name: &'a str,
    data_type: u64,
    dims: Vec<Option<usize>>,
}

impl<'a> ValueInfo<'a> {
    fn read(info: &'a [u8]) -> Result<Self> {
        let mut value = Self { name: "", data_type: 0, dims: Vec::new() };
        for field in Fields::new(info) {
            let field = field?;
            match (field.number, field.value) {
                (1, Value::Bytes(bytes)) => value.name = text(bytes)?,
                (2, Value::Bytes(bytes)) => value.read_type(bytes)?,
                _ => {}
            }
        }
        Ok(value)
    }

    fn read_type(&mut self, bytes: &[u8]) -> Result<()> {
        for field in Fields::new(bytes) {
            let field = field?;
            let (1, Value::Bytes(tensor)) = (field.number, field.value) else { continue };
            for field in Fields::new(tensor) {
                let field = field?;
                match (field.number, field.value) {
                    (1, Value::Varint(value)) => self.data_type = value,
                    (2, Value::Bytes(shape)) => self.read_shape(shape)?,
                    _ => {}
                }
            }
        }
        Ok(())
    }

    fn read_shape(&mut self, bytes: &[u8]) -> Result<()> {
        for field in Fields::new(bytes) {
            let field = field?;
            let (1, Value::Bytes(dim)) = (field.number, field.value) else { continue };
            let mut size = None;
            for field in Fields::new(dim) {
                let field = field?;
                if let (1, Value::Varint(value)) = (field.number, field.value) {
                    // A size of -1 means "unknown" in files of old exporters.
                    size = match value.cast_signed() {
                        -1 => None,
                        known => Some(usize::try_from(known).map_err(|_| {
                            Error::format(format!(
                                "{:?} of the ONNX model has a dimension of {known}",
                                self.name
                            ))
                        })?),
                    };
                }
            }
            self.dims.push(size);
        }
        Ok(())
    }

    fn tensor_info(self) -> Result<TensorInfo> {
        let Self { name, data_type, dims } = self;
        let element_type = match data_type {
            1 => ElementType::F32,
            2 => ElementType::U8,
            3 => ElementType::I8,
            6 => ElementType::I32,
            7 => ElementType::I64,
            9 => ElementType::Bool,
            other => {
                return Err(Error::unsupported(format!(
                    "{name:?} of the ONNX model has ONNX type {other}; a session supports tensors of f32, i32, i64, \
                     u8, i8 and bool"
                )));
            }
        };
        if dims.len() > MAX_RANK {
            return Err(Error::unsupported(format!(
                "{name:?} of the ONNX model has {} dimensions; a tensor has at most {MAX_RANK}",
                dims.len()
            )));
        }
        Ok(TensorInfo { name: name.to_owned(), element_type, dims })
    }
}
