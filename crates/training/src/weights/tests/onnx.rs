use opendr_onnx::proto::{AttributeProto, AttributeType, DataType, GraphProto, NodeProto, TensorProto};
use opendr_onnx::{bytes_from_model, model_from_graph};

use super::*;

fn tensor(name: &str, kind: DataType, dims: &[i64], raw_data: Vec<u8>) -> TensorProto {
    TensorProto {
        name: name.to_owned(),
        data_type: kind as i32,
        dims: dims.to_vec(),
        raw_data,
        ..TensorProto::default()
    }
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn node(name: &str, inputs: &[&str], output: &str) -> NodeProto {
    NodeProto {
        op_type: name.to_owned(),
        input: inputs.iter().map(|input| (*input).to_owned()).collect(),
        output: vec![output.to_owned()],
        ..NodeProto::default()
    }
}

fn int(mut node: NodeProto, name: &str, value: i64) -> NodeProto {
    node.attribute.push(AttributeProto {
        name: name.to_owned(),
        r#type: AttributeType::Int as i32,
        i: value,
        ..AttributeProto::default()
    });
    node
}

/// Returns a convolution with a scale per output and a 32-bit bias, and a product with a sum.
pub(super) fn quantised() -> Vec<u8> {
    let graph = GraphProto {
        initializer: vec![
            tensor("k", DataType::Uint8, &[2, 1, 2, 2], vec![128, 130, 126, 128, 0, 255, 10, 20]),
            tensor("k_scale", DataType::Float, &[2], floats(&[0.5, 0.25])),
            tensor("k_zero", DataType::Uint8, &[2], vec![128, 10]),
            tensor("b", DataType::Int32, &[2], [300i32, -4].map(i32::to_le_bytes).concat()),
            tensor("b_scale", DataType::Float, &[], floats(&[0.01])),
            tensor("d.weight", DataType::Float, &[2, 3], floats(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])),
            tensor("d_bias", DataType::Float, &[3], floats(&[7.0, 8.0, 9.0])),
        ],
        node: vec![
            int(node("DequantizeLinear", &["k", "k_scale", "k_zero"], "k_float"), "axis", 0),
            node("DequantizeLinear", &["b", "b_scale"], "b_float"),
            node("Conv", &["x", "k_float", "b_float"], "y"),
            node("Reshape", &["y", "shape"], "z"),
            node("MatMul", &["z", "d.weight"], "product"),
            node("Add", &["d_bias", "product"], "sum"),
        ],
        ..GraphProto::default()
    };
    bytes_from_model(&model_from_graph(graph))
}

#[test]
fn integers_are_dequantised() {
    let table = WeightTable::from_bytes(&quantised()).unwrap();
    let names: Vec<_> = table.weights().iter().map(Weight::name).collect();
    assert_eq!(names, ["k.weight", "k.bias", "d.weight", "d.bias"]);
    assert_eq!(table.get("k.weight").unwrap().values(), [0.0, 1.0, -1.0, 0.0, -2.5, 61.25, 0.0, 2.5]);
    assert_near(table.get("k.bias").unwrap().values(), &[3.0, -0.04]);
    let dense = table.get("d.weight").unwrap();
    assert_eq!((dense.shape(), dense.values()), (&[3, 2][..], &[1.0, 4.0, 2.0, 5.0, 3.0, 6.0][..]));
    let (module, report) = table.apply(plain(true), &Rules::by_order()).unwrap();
    report.complete().unwrap();
    let weight: Vec<f32> = module.dense.weight.val().into_data().try_to_vec().unwrap();
    assert_eq!(weight, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
}

#[test]
fn half_precision_has_the_names_of_the_tensors_it_is_cast_to() {
    let graph = |to: DataType| GraphProto {
        initializer: vec![
            tensor(
                "k.weight/half",
                DataType::Float16,
                &[1, 1, 1, 2],
                [0x3800_u16, 0xc000].map(u16::to_le_bytes).concat(),
            ),
            tensor("k.bias/half", DataType::Float16, &[1], 0x4200_u16.to_le_bytes().to_vec()),
        ],
        node: vec![
            int(node("Cast", &["k.weight/half"], "k.weight"), "to", to as i64),
            int(node("Cast", &["k.bias/half"], "k.bias"), "to", to as i64),
            node("Conv", &["x", "k.weight", "k.bias"], "y"),
        ],
        ..GraphProto::default()
    };
    let bytes = |to| bytes_from_model(&model_from_graph(graph(to)));
    let table = WeightTable::from_bytes(&bytes(DataType::Float)).unwrap();
    let weights: Vec<_> = table.weights().iter().map(|weight| (weight.name(), weight.values())).collect();
    assert_eq!(weights, [("k.weight", &[0.5, -2.0][..]), ("k.bias", &[3.0][..])]);
    assert_eq!(WeightTable::from_bytes(&bytes(DataType::Int32)).unwrap_err().kind(), ErrorKind::Format);
}

#[test]
fn cyclic_graphs_and_external_files_are_refused() {
    let mut looped = GraphProto {
        node: vec![
            node("Identity", &["b"], "a"),
            node("Identity", &["a"], "b"),
            node("Conv", &["x", "a"], "y"),
        ],
        ..GraphProto::default()
    };
    let error = WeightTable::from_bytes(&bytes_from_model(&model_from_graph(looped.clone()))).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Format);
    let outside = TensorProto { data_location: 1, ..tensor("w", DataType::Float, &[1], Vec::new()) };
    looped.initializer.push(outside);
    let error = WeightTable::from_bytes(&bytes_from_model(&model_from_graph(looped))).unwrap_err();
    assert!(error.kind() == ErrorKind::Unsupported && error.to_string().contains("another file"));
}

#[test]
fn published_models_yield_all_their_layers() {
    let Some(shared) = std::env::var_os("OPENDR_TEST_DATA").map(PathBuf::from) else {
        println!("skipped: no OPENDR_TEST_DATA");
        return;
    };
    for (file, layers, numbers) in [
        ("pose/posenet_mnv1_385.onnx", 31, 1_258_195),
        ("classification/mobilenet_v2_1.0_224_qdq.onnx", 53, 3_489_097),
        ("object_detection_2d/nanodet_coco_416.onnx", 34, 3_786_068),
        ("face_detection/ultraface_rfb_320.onnx", 52, 0),
    ] {
        let table = WeightTable::from_file(&shared.join("models").join(file)).unwrap();
        let kernels = table.weights().iter().filter(|weight| weight.shape().len() == 4).count();
        let biases = table.weights().iter().filter(|weight| weight.name().ends_with(".bias")).count();
        assert_eq!(kernels, layers, "{file}");
        let sum: usize = table.weights().iter().map(|weight| weight.values().len()).sum();
        if numbers > 0 {
            assert_eq!((biases, sum), (layers, numbers), "{file}");
        }
        assert!(table.weights().iter().flat_map(Weight::values).all(|number| number.is_finite()));
    }
}
