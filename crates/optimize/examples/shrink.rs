//! Quantises an ONNX file or converts it to FP16: `shrink PRECISION FROM.onnx TO.onnx`, with ranges from normally
//! distributed inputs.

use std::path::Path;

use opendr_engine::model::{Manifest, ModelWriter};
use opendr_engine::params::Params;
use opendr_engine::{Device, Error, Random, Result, Silent};
use opendr_inference::{Session, TensorView, recording};
use opendr_optimize::{OptimizeOptions, optimize};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [precision, from, to] = arguments.as_slice() else {
        return Err(Error::invalid_param("shrink PRECISION FROM.onnx TO.onnx"));
    };
    let mut options = OptimizeOptions::default();
    options.set_text("precision", precision)?;
    let (before, after) = (format!("{to}.before"), format!("{to}.after"));
    let mut writer = ModelWriter::new(&before, Manifest::new("", ""))?;
    writer.add("model.onnx", &std::fs::read(from)?)?;
    let model = writer.finish()?;
    let session = Session::open(&model.onnx()?, Device::Cpu)?;
    let mut random = Random::new(0);
    recording::start();
    for _ in 0..16 {
        let shapes: Vec<Vec<usize>> = session
            .inputs()
            .iter()
            .map(|input| input.dims.iter().map(|dim| dim.unwrap_or(1)).collect())
            .collect();
        let mut draw = |shape: &Vec<usize>| -> Vec<f32> {
            (0..shape.iter().product()).map(|_| random.normal() as f32).collect()
        };
        let given: Vec<Vec<f32>> = shapes.iter().map(&mut draw).collect();
        let views = shapes.iter().zip(&given).map(|(shape, values)| TensorView::new(shape, values));
        session.run(&views.collect::<Result<Vec<_>>>()?, |_| Ok(()))?;
    }
    let report = optimize(&model, &options, &recording::take(), None, Device::Cpu, after.as_ref(), &Silent)?;
    std::fs::copy(Path::new(&after).join("model.onnx"), to)?;
    println!("{report}");
    Ok(())
}
