//! A tiny Whisper in the formats of CTranslate2, transformers and PyTorch becomes two networks that work together;
//! damaged files are rejected.

use opendr_engine::ErrorKind;
use opendr_executor::{Data, Executor, Tensor};
use opendr_import::{
    WhisperOnnx, is_exported_whisper, whisper_from_ctranslate2, whisper_from_onnx, whisper_from_safetensors,
};
use opendr_kernels::Compute;
use opendr_onnx::proto::{AttributeProto, DataType, GraphProto, NodeProto, TensorProto};
use opendr_onnx::{bytes_from_model, model_from_graph};

const WIDTH: usize = 64;
const BANDS: usize = 2;
const TOKENS: usize = 12;

/// Returns small pseudo-random numbers, as `float16`.
fn halves(count: usize, seed: usize, scale: f32) -> Vec<u8> {
    let number = |at: usize| scale * ((at * 7919 + seed * 104_729) % 2003) as f32 / 1001.5 - scale;
    (0..count).flat_map(|at| half::f16::from_f32(number(at)).to_le_bytes()).collect()
}

#[derive(Default)]
struct File {
    variables: Vec<u8>,
    count: u32,
    /// Names, shapes and numbers of the weights.
    weights: Vec<(String, Vec<usize>, Vec<u8>)>,
}

fn text(text: &str) -> Vec<u8> {
    let mut bytes = (text.len() as u16 + 1).to_le_bytes().to_vec();
    bytes.extend(text.bytes().chain([0]));
    bytes
}

impl File {
    fn add(&mut self, name: &str, dims: &[usize], element: u8, bytes: &[u8]) {
        self.variables.extend(text(name));
        self.variables.push(dims.len() as u8);
        self.variables.extend(dims.iter().flat_map(|dim| (*dim as u32).to_le_bytes()));
        self.variables.push(element);
        self.variables.extend((bytes.len() as u32).to_le_bytes());
        self.variables.extend(bytes);
        self.count += 1;
    }

    fn weight(&mut self, name: &str, dims: &[usize], scale: f32) {
        let bytes = halves(dims.iter().product(), self.count as usize, scale);
        self.add(name, dims, 4, &bytes);
        self.weights.push((name.to_owned(), dims.to_vec(), bytes));
    }

    fn linear(&mut self, name: &str, rows: usize) {
        self.weight(&format!("{name}/weight"), &[rows, WIDTH], 0.2);
        self.weight(&format!("{name}/bias"), &[rows], 0.1);
    }

    fn norm(&mut self, name: &str) {
        self.weight(&format!("{name}/gamma"), &[WIDTH], 1.0);
        self.weight(&format!("{name}/beta"), &[WIDTH], 0.1);
    }

    fn bytes(&self) -> Vec<u8> {
        let mut bytes = 6u32.to_le_bytes().to_vec();
        bytes.extend(text("WhisperSpec"));
        bytes.extend([3, self.count].map(u32::to_le_bytes).as_flattened());
        bytes.extend(&self.variables);
        bytes.extend(1u32.to_le_bytes());
        bytes.extend(text("decoder/projection/weight"));
        bytes.extend(text("decoder/embeddings/weight"));
        bytes
    }
}

fn tiny() -> Vec<u8> {
    tiny_file().bytes()
}

fn tiny_file() -> File {
    let mut file = File::default();
    file.weight("encoder/conv1/weight", &[WIDTH, BANDS, 3], 0.5);
    file.weight("encoder/conv1/bias", &[WIDTH], 0.1);
    file.weight("encoder/conv2/weight", &[WIDTH, WIDTH, 3], 0.1);
    file.weight("encoder/conv2/bias", &[WIDTH], 0.1);
    file.weight("encoder/position_encodings/encodings", &[1500, WIDTH], 0.1);
    file.weight("decoder/embeddings/weight", &[TOKENS, WIDTH], 1.0);
    file.weight("decoder/position_encodings/encodings", &[448, WIDTH], 0.3);
    for side in ["encoder", "decoder"] {
        file.add(&format!("{side}/num_heads"), &[], 2, &[1, 0]);
        file.norm(&format!("{side}/layer_norm"));
        let layer = format!("{side}/layer_0");
        file.norm(&format!("{layer}/self_attention/layer_norm"));
        file.linear(&format!("{layer}/self_attention/linear_0"), 3 * WIDTH);
        file.linear(&format!("{layer}/self_attention/linear_1"), WIDTH);
        file.norm(&format!("{layer}/ffn/layer_norm"));
        file.linear(&format!("{layer}/ffn/linear_0"), WIDTH);
        file.linear(&format!("{layer}/ffn/linear_1"), WIDTH);
    }
    file.norm("decoder/layer_0/attention/layer_norm");
    file.linear("decoder/layer_0/attention/linear_0", WIDTH);
    file.linear("decoder/layer_0/attention/linear_1", 2 * WIDTH);
    file.linear("decoder/layer_0/attention/linear_2", WIDTH);
    file
}

/// Returns the same weights with the names of transformers, without the prefix `model.`: names, shapes and numbers.
fn renamed() -> Vec<(String, Vec<usize>, Vec<u8>)> {
    let names = [
        ("position_encodings/encodings", "embed_positions.weight"),
        ("embeddings/weight", "embed_tokens.weight"),
        ("self_attention/layer_norm", "self_attn_layer_norm"),
        ("ffn/layer_norm", "final_layer_norm"),
        ("ffn/linear_0", "fc1"),
        ("ffn/linear_1", "fc2"),
        ("self_attention/linear_0", "self_attn.[q_proj|k_proj|v_proj]"),
        ("self_attention/linear_1", "self_attn.out_proj"),
        ("attention/layer_norm", "encoder_attn_layer_norm"),
        ("attention/linear_0", "encoder_attn.q_proj"),
        ("attention/linear_1", "encoder_attn.[k_proj|v_proj]"),
        ("attention/linear_2", "encoder_attn.out_proj"),
        ("layer_0", "layers.0"),
        ("gamma", "weight"),
        ("beta", "bias"),
    ];
    let mut weights = Vec::new();
    for (name, dims, bytes) in tiny_file().weights {
        let name = names.iter().fold(name, |name, (from, to)| name.replace(from, to)).replace('/', ".");
        let (before, rest) = name.split_once('[').unwrap_or((&name, "]"));
        let (parts, after) = rest.split_once(']').unwrap();
        let parts: Vec<&str> = parts.split('|').collect();
        for (part, bytes) in parts.iter().zip(bytes.chunks_exact(bytes.len() / parts.len())) {
            let mut dims = dims.clone();
            dims[0] /= parts.len();
            weights.push((format!("{before}{part}{after}"), dims, bytes.to_vec()));
        }
    }
    weights
}

/// Returns the weights in the format of transformers.
fn tiny_safetensors() -> Vec<u8> {
    let (mut header, mut data) = (serde_json::Map::new(), Vec::new());
    for (name, dims, bytes) in renamed() {
        let places = [data.len(), data.len() + bytes.len()];
        let entry = serde_json::json!({"dtype": "F16", "shape": dims, "data_offsets": places});
        header.insert(format!("model.{name}"), entry);
        data.extend(bytes);
    }
    let header = serde_json::to_vec(&header).unwrap();
    [&(header.len() as u64).to_le_bytes(), header.as_slice(), data.as_slice()].concat()
}

/// Returns one network in the format of PyTorch's export: weights of dense layers transposed and unnamed, the
/// encoder's position encodings unnamed; inside `inner` nested graphs of an `If`.
fn tiny_exported(side: &str, prefix: &str, inner: usize) -> Vec<u8> {
    let mut graph = GraphProto::default();
    for (number, (name, dims, bytes)) in renamed().into_iter().enumerate() {
        let Some(rest) = name.strip_prefix(&format!("{side}.")) else { continue };
        let mut tensor = TensorProto {
            name: format!("{prefix}{rest}"),
            dims: dims.iter().map(|dim| *dim as i64).collect(),
            data_type: DataType::Float16 as i32,
            raw_data: bytes.clone(),
            ..TensorProto::default()
        };
        let module = rest.strip_suffix(".weight").unwrap_or("");
        if ["_proj", "fc1", "fc2"].iter().any(|end| module.ends_with(end)) {
            let (rows, columns) = (dims[0], dims[1]);
            let places =
                (0..columns).flat_map(|column| (0..rows).map(move |row| 2 * (row * columns + column)));
            tensor.raw_data = places.flat_map(|at| [bytes[at], bytes[at + 1]]).collect();
            tensor.dims.reverse();
            tensor.name = format!("onnx::MatMul_{number}");
            let module = format!("{prefix}{module}").replace('.', "/").replace("layers/", "layers.");
            graph.node.push(NodeProto {
                op_type: "MatMul".into(),
                name: format!("/{module}/MatMul"),
                input: vec!["x".into(), tensor.name.clone()],
                ..NodeProto::default()
            });
        } else if name == "encoder.embed_positions.weight" {
            tensor.name = format!("onnx::Add_{number}");
        } else if rest == "layer_norm.bias" {
            // Equal tensors are stored once.
            tensor.name = "other".into();
            graph.node.push(NodeProto {
                op_type: "Identity".into(),
                input: vec!["other".into()],
                output: vec![format!("{prefix}{rest}")],
                ..NodeProto::default()
            });
        }
        graph.initializer.push(tensor);
    }
    for _ in 0..inner {
        let attribute = AttributeProto { name: "then_branch".into(), g: Some(graph), ..Default::default() };
        let node = NodeProto { op_type: "If".into(), attribute: vec![attribute], ..NodeProto::default() };
        graph = GraphProto { node: vec![node], ..GraphProto::default() };
    }
    bytes_from_model(&model_from_graph(graph))
}

/// Runs a network of floats once; returns shapes and elements of its outputs.
fn run(onnx: &[u8], inputs: &[(&[usize], Data<'_>)]) -> Vec<(Vec<usize>, Vec<f32>)> {
    let mut executor = Executor::open(onnx, Compute::single()).unwrap();
    let inputs: Vec<Tensor<'_>> = inputs.iter().map(|&(shape, data)| Tensor { shape, data }).collect();
    let mut all = Vec::new();
    let ran = executor.run(&inputs, &mut |outputs| {
        all.extend(outputs.iter().map(|output| match output.data {
            Data::F32(data) => (output.shape.to_vec(), data.to_vec()),
            other => panic!("output of type {:?}", other.kind()),
        }));
        Ok(())
    });
    ran.unwrap();
    all
}

/// Decodes `tokens` in steps of the given sizes; returns the logits after the last.
fn decoded(networks: &WhisperOnnx, tokens: &[i64], steps: &[usize]) -> Vec<f32> {
    let mel: Vec<f32> = (0..BANDS * 3000).map(|at| (at as f32 * 0.37).sin()).collect();
    let heard = run(&networks.encoder, &[(&[1, BANDS, 3000], Data::F32(&mel))]);
    assert_eq!((&*heard[0].0, &*heard[1].0), (&[1, 64, 1500][..], &[1, 1500, 64][..]));
    let (mut keys, mut values) = (vec![0.0; WIDTH], vec![0.0; WIDTH]);
    let (mut logits, mut begin) = (Vec::new(), 0);
    for &count in steps {
        let rows = keys.len() / WIDTH;
        let places: Vec<i64> = (begin as i64..(begin + count) as i64).collect();
        let mask = (0..count * (rows + count)).map(|at| {
            let (row, column) = (at / (rows + count), at % (rows + count));
            if (1..=rows + row).contains(&column) { 0.0 } else { -1e9 }
        });
        let mask: Vec<f32> = mask.collect();
        let outputs = run(
            &networks.decoder,
            &[
                (&[count], Data::I64(&tokens[begin..begin + count])),
                (&[count], Data::I64(&places)),
                (&[count, rows + count], Data::F32(&mask)),
                (&[rows, WIDTH], Data::F32(&keys)),
                (&[rows, WIDTH], Data::F32(&values)),
                (&heard[0].0, Data::F32(&heard[0].1)),
                (&heard[1].0, Data::F32(&heard[1].1)),
            ],
        );
        let mut outputs = outputs.into_iter().map(|(_, numbers)| numbers);
        logits = outputs.next().unwrap();
        keys.extend(outputs.next().unwrap());
        values.extend(outputs.next().unwrap());
        begin += count;
    }
    logits
}

#[test]
fn incremental_decoding_equals_decoding_at_once() {
    let networks = whisper_from_ctranslate2(&tiny()).unwrap();
    let tokens = [3, 1, 4, 1, 5, 9];
    let whole = decoded(&networks, &tokens, &[6]);
    assert_eq!(whole.len(), TOKENS);
    assert!(whole.iter().any(|logit| (logit - whole[0]).abs() > 0.1), "{whole:?}");
    for steps in [&[1, 1, 1, 1, 1, 1][..], &[2, 3, 1]] {
        let stepped = decoded(&networks, &tokens, steps);
        let close = whole.iter().zip(&stepped).all(|(a, b)| (a - b).abs() < 1e-4);
        assert!(close, "{whole:?} {stepped:?}");
    }
    let other = decoded(&networks, &[3, 1, 4, 1, 6, 9], &[6]);
    assert!(other.iter().zip(&whole).any(|(a, b)| (a - b).abs() > 1e-3));
}

#[test]
fn safetensors_give_the_same_networks() {
    let networks = whisper_from_safetensors(&tiny_safetensors()).unwrap();
    let wanted = whisper_from_ctranslate2(&tiny()).unwrap();
    assert!(networks.encoder == wanted.encoder && networks.decoder == wanted.decoder);
}

#[test]
fn exported_networks_give_the_same_ones() {
    let wanted = whisper_from_safetensors(&tiny_safetensors()).unwrap();
    let encoder = tiny_exported("encoder", "", 0);
    assert!(is_exported_whisper(&encoder) && !is_exported_whisper(&wanted.encoder));
    for (prefix, inner) in [("", 0), ("model.decoder.", 0), ("model.decoder.", 2)] {
        let networks = whisper_from_onnx(&encoder, &tiny_exported("decoder", prefix, inner)).unwrap();
        assert!(networks.encoder == wanted.encoder && networks.decoder == wanted.decoder, "{prefix} {inner}");
    }
}

#[test]
fn networks_of_images_with_attention_are_no_whisper() {
    let mut model = opendr_onnx::model_from_bytes(&tiny_exported("encoder", "", 0)).unwrap();
    let kernel = AttributeProto { name: "kernel_shape".into(), ints: vec![16, 16], ..Default::default() };
    let patches = NodeProto { op_type: "Conv".into(), attribute: vec![kernel], ..Default::default() };
    model.graph.as_mut().unwrap().node.insert(0, patches);
    assert!(!is_exported_whisper(&bytes_from_model(&model)));
}

#[test]
fn other_and_damaged_networks_are_refused() {
    let (encoder, decoder) = (tiny_exported("encoder", "", 0), tiny_exported("decoder", "model.decoder.", 1));
    assert!(whisper_from_onnx(&decoder, &encoder).is_err());
    for size in (0..encoder.len()).step_by(997) {
        assert!(whisper_from_onnx(&encoder[..size], &decoder).is_err(), "{size} bytes");
    }
    for place in (0..decoder.len()).step_by(331) {
        let mut damaged = decoder.clone();
        damaged[place] ^= 0x11;
        whisper_from_onnx(&encoder, &damaged).ok();
    }
    // Stored like a quantised one: there are products, but not of floats.
    let mut model = opendr_onnx::model_from_bytes(&encoder).unwrap();
    for tensor in &mut model.graph.as_mut().unwrap().initializer {
        tensor.data_type = DataType::Int8 as i32;
    }
    let error = whisper_from_onnx(&bytes_from_model(&model), &decoder).unwrap_err();
    assert!(error.kind() == ErrorKind::Unsupported && error.to_string().contains("quantised"), "{error}");
}

#[test]
fn other_and_damaged_safetensors_are_refused() {
    let whole = tiny_safetensors();
    let kind = |bytes: &[u8]| whisper_from_safetensors(bytes).err().map(|error| error.kind());
    for size in (0..5000).step_by(7).chain((5000..whole.len()).step_by(9973)) {
        assert_eq!(kind(&whole[..size]), Some(ErrorKind::Format), "{size} bytes");
    }
    for place in 0..4000 {
        let mut damaged = whole.clone();
        damaged[place] ^= 0x11;
        whisper_from_safetensors(&damaged).ok();
    }
    let other = [&2u64.to_le_bytes()[..], b"{}"].concat();
    assert_eq!(kind(&other), Some(ErrorKind::Unsupported));
}

#[test]
fn weights_stay_as_small_as_they_came() {
    let file = tiny();
    let networks = whisper_from_ctranslate2(&file).unwrap();
    let size = networks.encoder.len() + networks.decoder.len();
    assert!(size < file.len() + 40_000, "{size} of {}", file.len());
}

#[test]
fn damage_is_refused_and_never_panics() {
    let whole = tiny();
    let kind = |bytes: &[u8]| whisper_from_ctranslate2(bytes).err().map(|error| error.kind());
    for size in (0..2000).chain((2000..whole.len()).step_by(9973)) {
        assert_eq!(kind(&whole[..size]), Some(ErrorKind::Format), "{size} bytes");
    }
    let mut longer = whole.clone();
    longer.push(0);
    assert_eq!(kind(&longer), Some(ErrorKind::Format));
    // Names, sizes and types are stored between the elements: every byte near a name is changed once.
    let names: Vec<usize> =
        whole.windows(6).enumerate().filter(|(_, at)| *at == b"coder/").map(|(at, _)| at).collect();
    for place in names.iter().step_by(5).flat_map(|name| name.saturating_sub(4)..name + 60) {
        let mut damaged = whole.clone();
        if let Some(byte) = damaged.get_mut(place) {
            *byte ^= 0x81;
            whisper_from_ctranslate2(&damaged).ok();
        }
    }
    let mut other = whole.clone();
    other[0] = 3;
    assert_eq!(kind(&other), Some(ErrorKind::Unsupported));
}
