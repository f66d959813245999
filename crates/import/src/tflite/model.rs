//! The parts of a TensorFlow Lite file that the importer needs.

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::{Array, element_count};

use super::element::Element;
use super::flatbuffer::{Flatbuffer, Table};
use super::quantisation::Quantisation;
use crate::tensorflow::MAX_RANK;

/// Number of the operator code for custom operators.
const CUSTOM: i32 = 32;

/// The graph of a file: its operators in order of execution.
pub struct Model<'a, 'f> {
    pub tensors: Vec<Tensor<'a>>,
    pub inputs: Vec<usize>,
    pub outputs: Vec<usize>,
    pub operators: Vec<Node<'a, 'f>>,
}

/// A tensor.
pub struct Tensor<'a> {
    /// Name, not always unique.
    pub name: &'a str,
    /// Dimensions; -1 where open.
    pub dims: Vec<i64>,
    pub element: Element,
    pub quantisation: Option<Quantisation>,
    /// Elements of a constant.
    bytes: &'a [u8],
    sparse: bool,
    external: bool,
}

/// An operator.
pub struct Node<'a, 'f> {
    /// Number of the operator, and the name of a custom one.
    pub code: i32,
    pub custom: &'a str,
    /// Input tensors; `None` for an omitted optional input.
    pub inputs: Vec<Option<usize>>,
    pub outputs: Vec<usize>,
    /// Parameters.
    pub options: Option<Table<'a, 'f>>,
    pub custom_options: &'a [u8],
}

impl<'a, 'f> Model<'a, 'f> {
    /// Reads the first graph of a file.
    ///
    /// # Errors
    /// `Format` for a damaged or inconsistent file, `Unsupported` for quantisations that ONNX lacks.
    pub fn read(file: &'f Flatbuffer<'a>) -> Result<Self> {
        let root = file.root()?;
        let buffers = root.tables(4)?;
        let codes = root.tables(1)?.iter().map(operator_code).collect::<Result<Vec<_>>>()?;
        let graphs = root.tables(2)?;
        let graph = graphs.first().ok_or_else(|| Error::format("the TensorFlow Lite model has no graph"))?;
        let tensors = graph.tables(0)?;
        let tensors = tensors.iter().enumerate().map(|(index, tensor)| {
            Tensor::read(tensor, &buffers).context(|| format!("reading tensor {index}"))
        });
        let tensors = tensors.collect::<Result<Vec<_>>>()?;
        let index = |tensor: i32| {
            usize::try_from(tensor).ok().filter(|&tensor| tensor < tensors.len()).ok_or_else(|| {
                Error::format(format!("tensor {tensor} is needed, but there are {}", tensors.len()))
            })
        };
        let optional = |tensor: i32| if tensor == -1 { Ok(None) } else { index(tensor).map(Some) };
        let mut operators = Vec::new();
        for table in graph.tables(3)? {
            let (code, custom) = usize::try_from(table.int(0, 0)?)
                .ok()
                .and_then(|code| codes.get(code).copied())
                .ok_or_else(|| Error::format("an operator refers to a code that the model does not list"))?;
            operators.push(Node {
                code,
                custom,
                inputs: table.ints(1)?.into_iter().map(optional).collect::<Result<_>>()?,
                outputs: table.ints(2)?.into_iter().map(index).collect::<Result<_>>()?,
                options: table.table(4)?,
                custom_options: table.bytes(5)?,
            });
        }
        let inputs = graph.ints(1)?.into_iter().map(index).collect::<Result<_>>()?;
        let outputs = graph.ints(2)?.into_iter().map(index).collect::<Result<_>>()?;
        Ok(Self { tensors, inputs, outputs, operators })
    }
}

/// Returns the number of an operator, and its name if it is custom. Old files store the number in a byte; new ones
/// have there at most what fits.
fn operator_code<'a>(table: &Table<'a, '_>) -> Result<(i32, &'a str)> {
    let (old, new) = (i32::from(table.byte(0)?.cast_signed()), table.int(3, 0)?);
    let code = old.max(new);
    Ok((code, if code == CUSTOM { table.text(1)? } else { "" }))
}

impl<'a> Tensor<'a> {
    fn read(table: &Table<'a, '_>, buffers: &[Table<'a, '_>]) -> Result<Self> {
        let shape = table.ints(0)?;
        let signature = table.ints(7)?;
        let dims = if signature.len() == shape.len() { signature } else { shape };
        if dims.len() > MAX_RANK {
            return Err(Error::format(format!("{} axes exceed the limit of {MAX_RANK}", dims.len())));
        }
        let dims: Vec<i64> = dims.into_iter().map(i64::from).collect();
        let element = Element::from(table.byte(1)?);
        let quantisation = match table.table(4)? {
            Some(parameters) => Quantisation::of(&parameters, element, dims.len())?,
            None => None,
        };
        // Buffer 0 is empty and means "none".
        let number = usize::try_from(table.int(2, 0)?).ok();
        let buffer = number.and_then(|number| buffers.get(number));
        let (bytes, external) = match buffer {
            Some(buffer) => (buffer.bytes(0)?, buffer.has(1)),
            None if number == Some(0) => (&[][..], false),
            None => return Err(Error::format(format!("there is no buffer {number:?}"))),
        };
        let sparse = table.has(6);
        Ok(Self { name: table.text(3)?, dims, element, quantisation, bytes, sparse, external })
    }

    /// Returns the tensor's name as an input or output of the model.
    pub fn port(&self) -> &'a str {
        self.name.strip_suffix(":0").unwrap_or(self.name)
    }

    /// Returns whether the elements are in the file.
    pub fn is_constant(&self) -> bool {
        !self.bytes.is_empty() || self.external || self.dims.contains(&0)
    }

    /// Returns the elements of a constant.
    ///
    /// # Errors
    /// `Format` when their number does not match the dimensions; `Unsupported` for sparse tensors and strings.
    pub fn array(&self) -> Result<Array> {
        if self.sparse {
            return Err(Error::unsupported(format!(
                "tensor {:?} is sparse; use a model with dense weights",
                self.name
            )));
        }
        if self.external {
            return Err(Error::unsupported(format!(
                "the elements of {:?} are stored outside the model, which is not supported",
                self.name
            )));
        }
        let dims: Option<Vec<usize>> = self.dims.iter().map(|&dim| usize::try_from(dim).ok()).collect();
        let width = self.element.width()?;
        let size =
            dims.as_ref().and_then(|dims| element_count(dims)).and_then(|count| count.checked_mul(width));
        let array = match (dims, size == Some(self.bytes.len())) {
            (Some(dims), true) => {
                Array::new(dims, self.element.decode(self.bytes, self.quantisation.is_some()))
            }
            _ => None,
        };
        array.ok_or_else(|| {
            Error::format(format!(
                "tensor {:?} of shape {:?} has {} bytes; download the file again",
                self.name,
                self.dims,
                self.bytes.len()
            ))
        })
    }
}
