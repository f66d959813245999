//! Layers of encoder and decoder. Positions are rows: tensors are `[positions, features]`.

use opendr_engine::{Error, Result};
use opendr_onnx::{Array, Builder, Data, Dim, ElementType, GraphTensor, Operator};

use super::sizes::HEAD;
use super::weights::WhisperWeights;

/// A graph under construction and its weights.
pub struct Layers<'a> {
    pub graph: Builder,
    weights: &'a dyn WhisperWeights,
    width: usize,
    inner: usize,
}

impl<'a> Layers<'a> {
    pub fn new(weights: &'a dyn WhisperWeights, width: usize, inner: usize) -> Self {
        Self { graph: Builder::default(), weights, width, inner }
    }

    /// Returns a weight of known shape.
    pub fn weight(&self, name: &str, dims: &[usize]) -> Result<GraphTensor> {
        self.array(name, dims).map(|array| GraphTensor::named_constant(name, array))
    }

    fn array(&self, name: &str, dims: &[usize]) -> Result<Array> {
        let array = self.weights.get(name)?;
        match array.dims() == dims {
            true => Ok(array),
            false => {
                Err(Error::format(format!("{name} has the shape {:?} instead of {dims:?}", array.dims())))
            }
        }
    }

    /// Adds an operator on floats.
    pub fn add(
        &mut self,
        hint: &str,
        operator: Operator,
        inputs: &[&GraphTensor],
        dims: Vec<Dim>,
    ) -> Result<GraphTensor> {
        self.graph.add(hint, operator, inputs, ElementType::Float, dims)
    }

    /// Adds a dense layer; a missing or zero bias is omitted.
    pub fn linear(&mut self, name: &str, input: &GraphTensor, columns: usize) -> Result<GraphTensor> {
        let rows = input.dims().last().copied().flatten().unwrap_or_default();
        let (weight, bias) = (format!("{name}.weight"), format!("{name}.bias"));
        let matrix =
            GraphTensor::named_constant(&weight, transposed(&self.array(&weight, &[columns, rows])?)?);
        let dims = with_last(input.dims(), columns);
        let product = self.add(name, Operator::new("MatMul"), &[input, &matrix], dims.clone())?;
        if !self.weights.has(&bias) {
            return Ok(product);
        }
        let array = self.array(&bias, &[columns])?;
        // Keys have no bias; where they are stored together with queries, theirs is zero.
        if array.as_floats().is_some_and(|values| values.iter().all(|value| *value == 0.0)) {
            return Ok(product);
        }
        self.add(name, Operator::new("Add"), &[&product, &GraphTensor::named_constant(&bias, array)], dims)
    }

    pub fn norm(&mut self, name: &str, input: &GraphTensor) -> Result<GraphTensor> {
        let scale = self.weight(&format!("{name}.weight"), &[self.width])?;
        let bias = self.weight(&format!("{name}.bias"), &[self.width])?;
        let operator = Operator::new("LayerNormalization").int("axis", -1).float("epsilon", 1e-5);
        self.add(name, operator, &[input, &scale, &bias], input.dims().to_vec())
    }

    /// Adds the activation x / 2 (1 + erf(x / sqrt 2)), in the order of operations that runtimes recognise and fuse.
    pub fn gelu(&mut self, input: &GraphTensor) -> Result<GraphTensor> {
        let dims = input.dims().to_vec();
        let scaled = GraphTensor::scalar(std::f32::consts::SQRT_2);
        let scaled = self.add("gelu", Operator::new("Div"), &[input, &scaled], dims.clone())?;
        let erf = self.add("gelu", Operator::new("Erf"), &[&scaled], dims.clone())?;
        let sum = self.add("gelu", Operator::new("Add"), &[&erf, &GraphTensor::scalar(1.0)], dims.clone())?;
        let product = self.add("gelu", Operator::new("Mul"), &[input, &sum], dims.clone())?;
        self.add("gelu", Operator::new("Mul"), &[&product, &GraphTensor::scalar(0.5)], dims)
    }

    pub fn sum(&mut self, a: &GraphTensor, b: &GraphTensor) -> Result<GraphTensor> {
        self.add("sum", Operator::new("Add"), &[a, b], a.dims().to_vec())
    }

    /// Adds the block's feed-forward network with its residual connection.
    pub fn dense(&mut self, block: &str, input: &GraphTensor) -> Result<GraphTensor> {
        let hidden = self.norm(&format!("{block}.final_layer_norm"), input)?;
        let hidden = self.linear(&format!("{block}.fc1"), &hidden, self.inner)?;
        let hidden = self.gelu(&hidden)?;
        let hidden = self.linear(&format!("{block}.fc2"), &hidden, self.width)?;
        self.sum(input, &hidden)
    }

    /// Splits positions by heads: `[heads, positions, HEAD]`, or transposed for keys, `[heads, HEAD, positions]`.
    pub fn heads(&mut self, input: &GraphTensor, transpose: bool) -> Result<GraphTensor> {
        let (places, heads) = (input.dims().first().copied().flatten(), self.width / HEAD);
        let shape = GraphTensor::ints([-1, heads as i64, HEAD as i64]);
        let parted = vec![places, Some(heads), Some(HEAD)];
        let parted = self.add("heads", Operator::new("Reshape"), &[input, &shape], parted)?;
        let (order, dims) = match transpose {
            true => ([1, 2, 0], vec![Some(heads), Some(HEAD), places]),
            false => ([1, 0, 2], vec![Some(heads), places, Some(HEAD)]),
        };
        self.add("heads", Operator::new("Transpose").ints("perm", order), &[&parted], dims)
    }

    /// Adds attention of `queries` `[positions, width]` to `keys` and `values`, both split by heads; `mask` is added
    /// to the scores.
    pub fn attend(
        &mut self,
        queries: &GraphTensor,
        keys: &GraphTensor,
        values: &GraphTensor,
        mask: Option<&GraphTensor>,
    ) -> Result<GraphTensor> {
        let places = queries.dims().first().copied().flatten();
        let heads = Some(self.width / HEAD);
        let scale = GraphTensor::scalar((HEAD as f32).powf(-0.5));
        let queries =
            self.add("queries", Operator::new("Mul"), &[queries, &scale], queries.dims().to_vec())?;
        let queries = self.heads(&queries, false)?;
        let dims = vec![heads, places, keys.dims().last().copied().flatten()];
        let mut scores = self.add("scores", Operator::new("MatMul"), &[&queries, keys], dims)?;
        if let Some(mask) = mask {
            scores = self.sum(&scores, mask)?;
        }
        let softmax = Operator::new("Softmax").int("axis", -1);
        let weights = self.add("attention", softmax, &[&scores], scores.dims().to_vec())?;
        let dims = vec![heads, places, Some(HEAD)];
        let found = self.add("found", Operator::new("MatMul"), &[&weights, values], dims)?;
        let order = Operator::new("Transpose").ints("perm", [1, 0, 2]);
        let found = self.add("found", order, &[&found], vec![places, heads, Some(HEAD)])?;
        let shape = GraphTensor::ints([-1, self.width as i64]);
        self.add("found", Operator::new("Reshape"), &[&found, &shape], vec![places, Some(self.width)])
    }
}

fn with_last(dims: &[Dim], last: usize) -> Vec<Dim> {
    let mut dims = dims.to_vec();
    if let Some(dim) = dims.last_mut() {
        *dim = Some(last);
    }
    dims
}

fn transposed(array: &Array) -> Result<Array> {
    let wrong = || Error::internal("only matrices can be transposed");
    let (&[rows, columns], Some(floats)) = (array.dims(), array.as_floats()) else { return Err(wrong()) };
    let column = |at: usize| floats.iter().skip(at).step_by(columns.max(1)).copied();
    let floats = (0..columns).flat_map(column).collect();
    Array::new(vec![columns, rows], Data::Float(floats)).ok_or_else(wrong)
}
