//! Damaged and malicious ONNX files cause errors, never a panic. Alone in its process: it opens thousands of sessions.

#![allow(clippy::unwrap_used, clippy::panic)]

use opendr_detection::object_detection_2d::{ImportedDetector, ImportedDetectorParams};
use opendr_engine::data::Image;
use opendr_engine::learner::Handle;
use opendr_engine::{Device, Random};

use opendr_onnx::proto::StringStringEntryProto;
use opendr_onnx::{Builder, ElementType, GraphTensor, Operator, bytes_from_model, model_from_graph};

/// Number of mutated files.
const MUTATIONS: usize = 20_000;

/// A network of 32 x 32 pixels with the 21 candidates of a YOLO of 3 classes, in about 500 bytes; with prototypes of masks if it segments.
fn network(segments: bool) -> Vec<u8> {
    let mut graph = Builder::default();
    let dims = |dims: &[usize]| dims.iter().copied().map(Some).collect::<Vec<_>>();
    let x = graph.input("images", ElementType::Float, dims(&[1, 3, 32, 32]), &[]);
    let mut pool = |name: &str, kernel: [i64; 2], strides: [i64; 2], size: [usize; 2]| {
        let pool = Operator::new("AveragePool").ints("kernel_shape", kernel).ints("strides", strides);
        graph.add(name, pool, &[&x], ElementType::Float, dims(&[1, 3, size[0], size[1]])).unwrap()
    };
    let (fields, pooled) = match segments {
        true => (10, pool("pooled", [8, 5], [4, 3], [7, 10])),
        false => (7, pool("pooled", [8, 8], [4, 4], [7, 7])),
    };
    let prototypes = segments.then(|| pool("prototypes", [4, 4], [4, 4], [8, 8]));
    let shape = GraphTensor::ints([1, fields, 21]);
    let rows = graph.add(
        "rows",
        Operator::new("Reshape"),
        &[&pooled, &shape],
        ElementType::Float,
        dims(&[1, fields as usize, 21]),
    );
    graph.output("output0", &rows.unwrap(), "", &[]).unwrap();
    if let Some(prototypes) = &prototypes {
        graph.output("output1", prototypes, "", &[]).unwrap();
    }
    let mut model = model_from_graph(graph.finish("detector"));
    let entry = |(key, value): (&str, &str)| StringStringEntryProto { key: key.into(), value: value.into() };
    let metadata = [
        ("names", "{0: 'ball', 1: \"cone\", 2: 'door'}"),
        ("stride", "32"),
        ("task", if segments { "segment" } else { "detect" }),
    ];
    model.metadata_props = metadata.map(entry).into();
    bytes_from_model(&model)
}

#[test]
fn mutations_never_panic() {
    let networks = [network(false), network(true)];
    let folder = std::env::temp_dir().join(format!("opendr-mutations-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("mutated.onnx");
    let image = Image::from_rgb8(vec![200; 40 * 30 * 3], 40, 30).unwrap();
    let mut random = Random::new(1);
    let (mut loaded, mut inferred) = (0, 0);
    for round in 0..=MUTATIONS {
        let mut bytes = networks[round % 2].clone();
        // The first two files are unchanged.
        for _ in 0..(round / 2).min(1) * (1 + random.below(3)) {
            let at = random.below(bytes.len());
            match random.below(4) {
                0 => bytes[at] ^= 1 << random.below(8),
                1 => bytes[at] = random.below(256) as u8,
                2 => _ = bytes.remove(at),
                _ => bytes.insert(at, bytes[random.below(bytes.len())]),
            }
        }
        std::fs::write(&path, &bytes).unwrap();
        let mut detector =
            Handle::<ImportedDetector>::new(ImportedDetectorParams::default(), Device::Cpu).unwrap();
        if detector.load(&path).is_ok() {
            loaded += 1;
            inferred += usize::from(detector.infer(&image).is_ok());
        }
        assert!(round > 0 || inferred == 1, "the file without a mutation is a detector");
    }
    println!("{loaded} of {MUTATIONS} loaded, {inferred} inferred");
    std::fs::remove_dir_all(&folder).ok();
}
