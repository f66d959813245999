//! Small TensorFlow Lite models that the tests write.

use opendr_import::{ImportOptions, onnx_from_tflite};
use opendr_onnx::model_from_bytes;
use opendr_onnx::proto::GraphProto;

/// A field of a flatbuffer's table.
#[derive(Clone)]
pub enum Field {
    Byte(u8),
    Int(i32),
    /// A vector of bytes or a string.
    Bytes(Vec<u8>),
    Ints(Vec<i32>),
    Longs(Vec<i64>),
    Floats(Vec<f32>),
    Table(Table),
    Tables(Vec<Table>),
}

/// Fields by their number.
pub type Table = Vec<(usize, Field)>;

/// Returns a file with this root.
pub fn file(root: &Table) -> Vec<u8> {
    let mut bytes = b"\0\0\0\0TFL3".to_vec();
    let start = table(&mut bytes, root);
    point(&mut bytes, 0, start);
    bytes
}

fn point(bytes: &mut [u8], from: usize, to: usize) {
    bytes[from..from + 4].copy_from_slice(&((to - from) as u32).to_le_bytes());
}

/// Writes a table, with its vtable in front and its referenced values after it; every field takes four bytes.
fn table(bytes: &mut Vec<u8>, fields: &Table) -> usize {
    let list = bytes.len();
    let count = fields.iter().map(|(index, _)| index + 1).max().unwrap_or(0);
    let mut offsets = vec![0u16; count];
    fields.iter().enumerate().for_each(|(i, (index, _))| offsets[*index] = 4 + 4 * i as u16);
    bytes.extend((4 + 2 * count as u16).to_le_bytes());
    bytes.extend((4 + 4 * fields.len() as u16).to_le_bytes());
    bytes.extend(offsets.iter().flat_map(|offset| offset.to_le_bytes()));
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let start = bytes.len();
    bytes.extend(((start - list) as i32).to_le_bytes());
    for (_, field) in fields {
        let inline = match field {
            Field::Byte(value) => u32::from(*value),
            Field::Int(value) => value.cast_unsigned(),
            _ => 0,
        };
        bytes.extend(inline.to_le_bytes());
    }
    for (i, (_, field)) in fields.iter().enumerate() {
        let target = match field {
            Field::Byte(_) | Field::Int(_) => continue,
            Field::Bytes(values) => vector(bytes, values.len(), values),
            Field::Ints(values) => vector(bytes, values.len(), &raw(values, |value| value.to_le_bytes())),
            Field::Longs(values) => vector(bytes, values.len(), &raw(values, |value| value.to_le_bytes())),
            Field::Floats(values) => vector(bytes, values.len(), &raw(values, |value| value.to_le_bytes())),
            Field::Table(fields) => table(bytes, fields),
            Field::Tables(tables) => {
                let position = vector(bytes, tables.len(), &vec![0; 4 * tables.len()]);
                for (i, fields) in tables.iter().enumerate() {
                    let target = table(bytes, fields);
                    point(bytes, position + 4 + 4 * i, target);
                }
                position
            }
        };
        point(bytes, start + 4 + 4 * i, target);
    }
    start
}

fn vector(bytes: &mut Vec<u8>, count: usize, elements: &[u8]) -> usize {
    let start = bytes.len();
    bytes.extend((count as u32).to_le_bytes());
    bytes.extend(elements);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    start
}

/// Returns the little-endian bytes of numbers.
pub fn raw<T: Copy, const N: usize>(values: &[T], bytes: fn(T) -> [u8; N]) -> Vec<u8> {
    values.iter().flat_map(|&value| bytes(value)).collect()
}

/// Element types by their number.
pub const FLOAT32: u8 = 0;
pub const FLOAT16: u8 = 1;
pub const INT32: u8 = 2;
pub const UINT8: u8 = 3;
pub const INT8: u8 = 9;

/// A model under construction.
#[derive(Default)]
pub struct TinyLite {
    pub tensors: Vec<Table>,
    pub buffers: Vec<Vec<u8>>,
    pub operators: Vec<Table>,
    pub codes: Vec<i32>,
    pub inputs: Vec<i32>,
    pub outputs: Vec<i32>,
}

impl TinyLite {
    /// Adds a computed tensor.
    pub fn tensor(&mut self, name: &str, dims: &[i32], element: u8) -> i32 {
        self.constant(name, dims, element, Vec::new())
    }

    /// Adds an input.
    pub fn input(&mut self, dims: &[i32], element: u8) -> i32 {
        let tensor = self.tensor("x", dims, element);
        self.inputs.push(tensor);
        tensor
    }

    /// Adds a constant.
    pub fn constant(&mut self, name: &str, dims: &[i32], element: u8, bytes: Vec<u8>) -> i32 {
        if self.buffers.is_empty() {
            self.buffers.push(Vec::new());
        }
        let buffer = if bytes.is_empty() { 0 } else { self.buffers.len() as i32 };
        if buffer > 0 {
            self.buffers.push(bytes);
        }
        let name = Field::Bytes(name.as_bytes().to_vec());
        let dims = Field::Ints(dims.to_vec());
        self.tensors.push(vec![(0, dims), (1, Field::Byte(element)), (2, Field::Int(buffer)), (3, name)]);
        self.tensors.len() as i32 - 1
    }

    /// Adds a constant of floats.
    pub fn floats(&mut self, name: &str, dims: &[i32], values: &[f32]) -> i32 {
        self.constant(name, dims, FLOAT32, raw(values, f32::to_le_bytes))
    }

    /// Adds a constant of integers.
    pub fn ints(&mut self, name: &str, dims: &[i32], values: &[i32]) -> i32 {
        self.constant(name, dims, INT32, raw(values, i32::to_le_bytes))
    }

    /// Quantises a tensor with `(integer - zero) * scale`, with one scale per position of `axis`.
    pub fn quantise(&mut self, tensor: i32, scales: &[f32], zeros: &[i64], axis: i32) -> i32 {
        let (scales, zeros) = (Field::Floats(scales.to_vec()), Field::Longs(zeros.to_vec()));
        let parameters = vec![(2, scales), (3, zeros), (6, Field::Int(axis))];
        self.tensors[tensor as usize].push((4, Field::Table(parameters)));
        tensor
    }

    /// Adds an operator by its number.
    pub fn operator(&mut self, code: i32, inputs: &[i32], outputs: &[i32], options: Table) -> &mut Self {
        self.codes.push(code);
        let number = self.codes.len() as i32 - 1;
        self.operators.push(vec![
            (0, Field::Int(number)),
            (1, Field::Ints(inputs.to_vec())),
            (2, Field::Ints(outputs.to_vec())),
            (4, Field::Table(options)),
        ]);
        self
    }

    /// Returns the file.
    pub fn bytes(&self) -> Vec<u8> {
        let code = |&code: &i32| vec![(0, Field::Byte(code.min(127) as u8)), (3, Field::Int(code))];
        let graph = vec![
            (0, Field::Tables(self.tensors.clone())),
            (1, Field::Ints(self.inputs.clone())),
            (2, Field::Ints(self.outputs.clone())),
            (3, Field::Tables(self.operators.clone())),
        ];
        let buffers = self.buffers.iter().map(|bytes| vec![(0, Field::Bytes(bytes.clone()))]);
        file(&vec![
            (0, Field::Int(3)),
            (1, Field::Tables(self.codes.iter().map(code).collect())),
            (2, Field::Tables(vec![graph])),
            (4, Field::Tables(buffers.collect())),
        ])
    }

    /// Imports the model.
    pub fn import(&self) -> Vec<u8> {
        onnx_from_tflite(&self.bytes(), &ImportOptions::default()).unwrap()
    }

    /// Returns the imported graph.
    pub fn graph(&self) -> GraphProto {
        model_from_bytes(&self.import()).unwrap().graph.unwrap()
    }
}
