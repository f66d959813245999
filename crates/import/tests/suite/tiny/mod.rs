//! Small TensorFlow.js models that the tests write, and the runtime that runs the imported ones.

use opendr_engine::Result;
use opendr_executor::{Data, Executor, Tensor};
use opendr_import::{ImportOptions, onnx_from_tfjs};
use opendr_kernels::Compute;
use opendr_onnx::{model_from_bytes, proto::NodeProto};
use serde_json::{Value as Json, json};

/// A graph model under construction.
#[derive(Default)]
pub struct Tiny {
    pub nodes: Vec<Json>,
    pub weights: Vec<Json>,
    pub bytes: Vec<u8>,
    pub outputs: Vec<String>,
}

impl Tiny {
    /// Creates a model with one float input; -1 is an open dimension.
    pub fn with_input(dims: &[i64]) -> Self {
        let dims: Vec<Json> = dims.iter().map(|dim| json!({"size": dim.to_string()})).collect();
        let mut model = Self::default();
        let attr = json!({"dtype": {"type": "DT_FLOAT"}, "shape": {"shape": {"dim": dims}}});
        model.nodes.push(json!({"name": "x", "op": "Placeholder", "attr": attr}));
        model
    }

    /// Adds a node.
    pub fn node(&mut self, name: &str, op: &str, inputs: &[&str], attr: Json) -> &mut Self {
        self.nodes.push(json!({"name": name, "op": op, "input": inputs, "attr": attr}));
        self
    }

    /// Adds a constant of floats.
    pub fn floats(&mut self, name: &str, shape: &[usize], values: &[f32]) -> &mut Self {
        self.bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        self.constant(name, json!({"name": name, "shape": shape, "dtype": "float32"}))
    }

    /// Adds a constant of integers.
    pub fn ints(&mut self, name: &str, shape: &[usize], values: &[i32]) -> &mut Self {
        self.bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        self.constant(name, json!({"name": name, "shape": shape, "dtype": "int32"}))
    }

    fn constant(&mut self, name: &str, weight: Json) -> &mut Self {
        self.weights.push(weight);
        self.node(name, "Const", &[], json!({}))
    }

    /// Declares a node's first output as an output of the model.
    pub fn output(&mut self, name: &str) -> &mut Self {
        self.outputs.push(name.to_owned());
        self
    }

    /// Returns `model.json`.
    pub fn json(&self) -> Vec<u8> {
        let outputs: serde_json::Map<String, Json> =
            self.outputs.iter().map(|name| (name.clone(), json!({"name": format!("{name}:0")}))).collect();
        serde_json::to_vec(&json!({
            "format": "graph-model",
            "signature": {"outputs": outputs},
            "modelTopology": {"node": self.nodes},
            "weightsManifest": [{"paths": ["weights.bin"], "weights": self.weights}],
        }))
        .unwrap()
    }

    /// Imports the model.
    pub fn import(&self) -> Result<Vec<u8>> {
        onnx_from_tfjs(&self.json(), &[&self.bytes], &ImportOptions::default())
    }

    /// Returns the operators of the imported graph, in order.
    pub fn operators(&self) -> Vec<String> {
        self.imported_nodes().into_iter().map(|node| node.op_type).collect()
    }

    /// Returns the nodes of the imported graph, in order.
    pub fn imported_nodes(&self) -> Vec<NodeProto> {
        model_from_bytes(&self.import().unwrap()).unwrap().graph.unwrap().node
    }

    /// Imports the model and runs it on a channels-last image (or another input, unchanged); outputs are sorted by
    /// name.
    pub fn run(&self, dims: &[usize], values: &[f32]) -> Vec<Array> {
        run(self.import().unwrap(), dims, values)
    }
}

/// Runs an imported model on a channels-last image (or another input, unchanged).
pub fn run(onnx: Vec<u8>, dims: &[usize], values: &[f32]) -> Vec<Array> {
    let (dims, values) = match *dims {
        [batch, height, width, channels] => {
            let at = |image: usize, channel: usize, pixel: usize| {
                values[(image * height * width + pixel) * channels + channel]
            };
            let planes = (0..batch).flat_map(|image| (0..channels).map(move |channel| (image, channel)));
            let pixels = planes
                .flat_map(|(image, channel)| (0..height * width).map(move |pixel| at(image, channel, pixel)));
            (vec![batch, channels, height, width], pixels.collect())
        }
        _ => (dims.to_vec(), values.to_vec()),
    };
    let mut executor = Executor::open(&onnx, Compute::single()).unwrap();
    let mut arrays = Vec::new();
    let input = Tensor { shape: &dims, data: Data::F32(&values) };
    let ran = executor.run(&[input], &mut |outputs| {
        arrays.extend(outputs.iter().map(Array::from_tensor));
        Ok(())
    });
    ran.unwrap();
    arrays
}

/// A result: shape and elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    pub dims: Vec<usize>,
    pub values: Vec<f32>,
}

impl Array {
    fn from_tensor(tensor: &Tensor<'_>) -> Self {
        let values = match tensor.data {
            Data::F32(data) => data.to_vec(),
            Data::I32(data) => data.iter().map(|&value| value as f32).collect(),
            Data::I64(data) => data.iter().map(|&value| value as f32).collect(),
            other => panic!("output of type {:?}", other.kind()),
        };
        Self { dims: tensor.shape.to_vec(), values }
    }

    /// Checks shape and elements, to 1e-5.
    #[track_caller]
    pub fn assert_near(&self, dims: &[usize], values: &[f32]) {
        assert_eq!(self.dims, dims);
        assert_eq!(self.values.len(), values.len());
        for (index, (own, other)) in self.values.iter().zip(values).enumerate() {
            assert!(
                (own - other).abs() <= 1e-5 * other.abs().max(1.0),
                "element {index}: {own} instead of {other}"
            );
        }
    }
}

/// Returns pseudo-random numbers, the same every time, in -1..1.
pub fn noise(count: usize) -> Vec<f32> {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    (0..count)
        .map(|_| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 40) as f32 / (1 << 23) as f32 - 1.0
        })
        .collect()
}

/// Computes TensorFlow's convolution by its definition: image `[height, width, channels]`, filter
/// `[kernel, kernel, channels, filters]`, padding `SAME`; the result is channels-first.
pub fn convolved_same(
    x: &[f32],
    [height, width, channels]: [usize; 3],
    w: &[f32],
    [kernel, filters, stride]: [usize; 3],
) -> (Vec<usize>, Vec<f32>) {
    let out = [height.div_ceil(stride), width.div_ceil(stride)];
    let before = |size: usize, out: usize| (((out - 1) * stride + kernel).saturating_sub(size) / 2) as isize;
    let (top, left) = (before(height, out[0]), before(width, out[1]));
    let mut y = vec![0.0; filters * out[0] * out[1]];
    for f in 0..filters {
        for (row, column) in (0..out[0]).flat_map(|row| (0..out[1]).map(move |column| (row, column))) {
            let mut sum = 0.0;
            for (i, j, c) in (0..kernel * kernel * channels)
                .map(|n| (n / channels / kernel, n / channels % kernel, n % channels))
            {
                let (r, s) = ((row * stride + i) as isize - top, (column * stride + j) as isize - left);
                if (0..height as isize).contains(&r) && (0..width as isize).contains(&s) {
                    sum += x[(r as usize * width + s as usize) * channels + c]
                        * w[((i * kernel + j) * channels + c) * filters + f];
                }
            }
            y[(f * out[0] + row) * out[1] + column] = sum;
        }
    }
    (vec![1, filters, out[0], out[1]], y)
}

/// Returns the parameters of a convolution.
pub fn conv(stride: usize, padding: &str) -> Json {
    let stride = stride.to_string();
    json!({
        "strides": {"list": {"i": ["1", stride, stride, "1"]}},
        "dilations": {"list": {"i": ["1", "1", "1", "1"]}},
        "padding": {"s": base64(padding)},
    })
}

/// Returns the parameters of a convolution with fused operators.
pub fn fused(stride: usize, padding: &str, operators: &[&str]) -> Json {
    let mut attr = conv(stride, padding);
    let operators: Vec<String> = operators.iter().map(|operator| base64(operator)).collect();
    attr["fused_ops"] = json!({"list": {"s": operators}});
    attr["leakyrelu_alpha"] = json!({"f": 0.25});
    attr
}

/// Encodes in base64, as strings in `model.json` are.
pub fn base64(text: &str) -> String {
    const SYMBOLS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut encoded = String::new();
    for chunk in text.as_bytes().chunks(3) {
        let bits =
            chunk.iter().fold(0u32, |bits, &byte| bits << 8 | u32::from(byte)) << (8 * (3 - chunk.len()));
        for i in 0..4 {
            match i <= chunk.len() {
                true => encoded.push(char::from(SYMBOLS[(bits >> (18 - 6 * i) & 63) as usize])),
                false => encoded.push('='),
            }
        }
    }
    encoded
}
