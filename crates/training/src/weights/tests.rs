use std::io::Write;
use std::path::PathBuf;

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Linear, LinearConfig};
use burn::tensor::{Device, Tensor, TensorData};
use opendr_engine::{ErrorKind, Random};

use super::*;

mod hostile;
mod onnx;
mod torch;

#[derive(Module, Debug)]
struct Normed {
    conv: Conv2d,
    norm: BatchNorm,
    dense: Linear,
}

#[derive(Module, Debug)]
struct Plain {
    conv: Conv2d,
    dense: Linear,
}

fn conv(bias: bool) -> Conv2d {
    Conv2dConfig::new([1, 2], [2, 2]).with_bias(bias).init(&Device::flex())
}

fn normed(bias: bool) -> Normed {
    let norm = BatchNormConfig::new(2).init(&Device::flex());
    Normed { conv: conv(bias), norm, dense: LinearConfig::new(2, 3).init(&Device::flex()) }
}

fn plain(bias: bool) -> Plain {
    Plain { conv: conv(bias), dense: LinearConfig::new(2, 3).init(&Device::flex()) }
}

impl Normed {
    fn run(&self) -> Vec<f32> {
        head(self.norm.forward(self.conv.forward(picture())), &self.dense)
    }
}

impl Plain {
    fn run(&self) -> Vec<f32> {
        head(self.conv.forward(picture()), &self.dense)
    }
}

fn picture() -> Tensor<4> {
    let data = TensorData::new(vec![0.3f32, -1.0, 0.7, 2.0], [1, 1, 2, 2]);
    Tensor::from_data(data, &Device::flex())
}

fn head(features: Tensor<4>, dense: &Linear) -> Vec<f32> {
    dense.forward(features.reshape([1, 2])).into_data().try_to_vec().unwrap()
}

fn assert_near(a: &[f32], b: &[f32]) {
    assert!(a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5), "{a:?} {b:?}");
}

fn numbers(count: usize, seed: u64) -> Vec<f32> {
    let mut random = Random::new(seed);
    (0..count).map(|_| random.uniform(-1.0, 1.0)).collect()
}

/// Returns a convolution, optionally with bias and normalisation, and a linear layer, with PyTorch's names and layout.
fn weights(bias: bool, norm: bool) -> Vec<(String, Vec<usize>, Vec<f32>)> {
    let mut weights = vec![("0.weight".to_owned(), vec![2, 1, 2, 2], numbers(8, 1))];
    if bias {
        weights.push(("0.bias".to_owned(), vec![2], numbers(2, 2)));
    }
    if norm {
        for (seed, name) in [(3, "weight"), (4, "bias"), (5, "running_mean")] {
            weights.push((format!("1.{name}"), vec![2], numbers(2, seed)));
        }
        weights.push(("1.running_var".to_owned(), vec![2], vec![0.5, 2.0]));
    }
    weights.push(("2.weight".to_owned(), vec![3, 2], numbers(6, 6)));
    weights.push(("2.bias".to_owned(), vec![3], numbers(3, 7)));
    weights
}

fn table(bias: bool, norm: bool) -> WeightTable {
    let mut table = WeightTable::default();
    for (name, shape, values) in weights(bias, norm) {
        table.add(name, shape, values).unwrap();
    }
    table
}

fn safetensors(weights: &[(String, Vec<usize>, Vec<f32>)]) -> Vec<u8> {
    let (mut header, mut data) = (serde_json::Map::new(), Vec::new());
    for (name, shape, values) in weights {
        let start = data.len();
        data.extend(values.iter().flat_map(|number| number.to_le_bytes()));
        let entry = serde_json::json!({"dtype": "F32", "shape": shape, "data_offsets": [start, data.len()]});
        header.insert(name.clone(), entry);
    }
    let header = serde_json::to_vec(&header).unwrap();
    [&(header.len() as u64).to_le_bytes(), header.as_slice(), data.as_slice()].concat()
}

/// Returns the bytes that `torch.save(state_dict)` writes, in pickle protocol 2.
fn checkpoint(weights: &[(String, Vec<usize>, Vec<f32>)]) -> Vec<u8> {
    let text = |text: &str| [b"X", &(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
    let number = |number: usize| [b"J", &(number as u32).to_le_bytes()[..]].concat();
    let tuple = |numbers: &[usize]| {
        let items: Vec<u8> = numbers.iter().flat_map(|item| number(*item)).collect();
        [b"(", items.as_slice(), b"t"].concat()
    };
    let mut pickle = b"\x80\x02}(".to_vec();
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let stored = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    for (index, (name, shape, values)) in weights.iter().enumerate() {
        let strides: Vec<usize> = (0..shape.len()).map(|axis| shape[axis + 1..].iter().product()).collect();
        pickle.extend(text(name));
        pickle.extend(b"ctorch._utils\n_rebuild_tensor_v2\n((");
        pickle.extend(text("storage"));
        pickle.extend(b"ctorch\nFloatStorage\n");
        pickle.extend([text(&index.to_string()), text("cpu"), number(values.len())].concat());
        pickle.extend(b"tQ");
        pickle.extend([number(0), tuple(shape), tuple(&strides)].concat());
        pickle.extend(b"\x89ccollections\nOrderedDict\n)RtR");
        zip.start_file(format!("archive/data/{index}"), stored).unwrap();
        zip.write_all(&values.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    }
    pickle.extend(b"u.");
    zip.start_file("archive/data.pkl", stored).unwrap();
    zip.write_all(&pickle).unwrap();
    zip.finish().unwrap().into_inner()
}

/// A file that is removed at the end of the test.
struct Temporary(PathBuf);

impl Temporary {
    fn new(name: &str, bytes: &[u8]) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-weights-{}-{name}", std::process::id()));
        std::fs::write(&path, bytes).unwrap();
        Self(path)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        std::fs::remove_file(&self.0).ok();
    }
}

#[test]
fn every_format_yields_the_same_table() {
    let wanted = table(true, true);
    let safetensors = Temporary::new("a.bin", &safetensors(&weights(true, true)));
    let checkpoint = Temporary::new("b.bin", &checkpoint(&weights(true, true)));
    for file in [safetensors, checkpoint] {
        let read = WeightTable::from_file(&file.0).unwrap();
        assert_eq!(read.weights().len(), wanted.weights().len());
        for weight in wanted.weights() {
            assert_eq!(read.get(weight.name()), Some(weight));
        }
    }
}

#[test]
fn weights_are_assigned_by_name() {
    let rules = Rules::by_name().rename("0.*", "conv.*").rename("1.*", "norm.*").rename("2.*", "dense.*");
    let (module, report) = table(true, true).apply(normed(true), &rules).unwrap();
    report.complete().unwrap();
    assert_eq!((report.loaded.len(), report.unexpected.len()), (8, 0));
    let dense: Vec<f32> = module.dense.weight.val().into_data().try_to_vec().unwrap();
    let [a, b, c, d, e, f] = numbers(6, 6)[..] else { panic!() };
    assert_eq!(dense, [a, c, e, b, d, f]);
    let mean: Vec<f32> = module.norm.running_mean.value().into_data().try_to_vec().unwrap();
    assert_eq!(mean, numbers(2, 5));
}

#[test]
fn mismatches_are_reported() {
    let rules = Rules::by_name().rename("0.*", "conv.*");
    let mut table = table(true, false);
    table.add("dense.bias", vec![5], vec![0.0; 5]).unwrap();
    let (_, report) = table.apply(plain(true), &rules).unwrap();
    assert_eq!(report.loaded, ["conv.weight", "conv.bias"]);
    assert_eq!(report.missing, ["dense.weight"]);
    assert_eq!(report.mismatched[0].actual, [5]);
    assert_eq!(report.unexpected, ["2.weight", "2.bias"]);
    let error = report.complete().unwrap_err();
    assert!(error.kind() == ErrorKind::InvalidInput && error.to_string().contains("dense.bias"), "{error}");

    let (_, report) = table.apply(plain(true), &rules.clone().skip("dense")).unwrap();
    report.complete().unwrap();
    let (_, report) = table.apply(plain(true), &rules.only("dense.weight")).unwrap();
    assert_eq!((report.loaded.len(), report.missing.len()), (0, 1));
    let clash = Rules::by_name().rename("0.*", "2.*");
    assert_eq!(table.apply(plain(true), &clash).unwrap_err().kind(), ErrorKind::InvalidParam);
}

#[test]
fn norms_are_kept_made_and_folded() {
    let order = Rules::by_order();
    let run_normed = |source: &WeightTable, bias| {
        let (module, report) = source.apply(normed(bias), &order).unwrap();
        report.complete().unwrap();
        module.run()
    };
    for bias in [true, false] {
        // With a normalisation in the file: kept, its bias in the mean, or folded.
        let source = table(bias, true);
        let wanted = run_normed(&source, true);
        assert_near(&run_normed(&source, false), &wanted);
        let (module, report) = source.apply(plain(true), &order).unwrap();
        report.complete().unwrap();
        assert_near(&module.run(), &wanted);
        // Folded in the file: an identity, which may hold the bias.
        let source = table(bias, false);
        let (module, _) = source.apply(plain(true), &order).unwrap();
        assert_near(&run_normed(&source, true), &module.run());
        assert_near(&run_normed(&source, false), &module.run());
    }
}

#[test]
fn layers_out_of_order_are_refused_by_number() {
    let mut source = WeightTable::default();
    source.add("a.weight", vec![2, 1, 2, 2], vec![0.0; 8]).unwrap();
    source.add("b.weight", vec![3, 3], vec![0.0; 9]).unwrap();
    let error = source.apply(plain(true), &Rules::by_order()).unwrap_err().to_string();
    assert!(
        error.contains("layer 2") && error.contains("dense.weight") && error.contains("[3, 3]"),
        "{error}"
    );
    let error = table(true, false).apply(plain(false), &Rules::by_order()).unwrap_err().to_string();
    assert!(error.contains("a bias"), "{error}");

    let (_, report) = table(true, false).apply(conv(true), &Rules::by_order()).unwrap();
    report.complete().unwrap();
    assert_eq!(report.unexpected, ["2.weight", "2.bias"]);
}

#[test]
fn gradients_and_identity_of_parameters_stay() {
    let module = plain(true).to_device(&Device::flex().autodiff()).train();
    let ids = (module.conv.weight.id, module.dense.weight.id);
    let (module, _) = table(true, false).apply(module, &Rules::by_order()).unwrap();
    assert_eq!((module.conv.weight.id, module.dense.weight.id), ids);
    assert!(module.conv.weight.val().is_require_grad());
}
