//! Exported models return Burn's outputs in both runtimes.

use crate::architectures;
use crate::architectures::case::{Run, Values};
use opendr_engine::{Device, Error, Result};
use opendr_inference::{Builtin, OnnxRuntime, Runtime, Session, TensorView};

/// Maximum difference between a runtime and Burn, as a share of an output's largest magnitude.
const TOLERANCE: f32 = 1e-4;

fn outputs(runtime: &dyn Runtime, run: &Run) -> Result<Vec<Values>> {
    let model = run.model.as_ref().map_err(|error| Error::internal(error.to_string()))?;
    let session = Session::open_with(runtime, model, Device::Cpu)?;
    let input = TensorView::new(&run.input.shape, &run.input.values)?;
    let mut outputs = Vec::new();
    session.run(&[input], |results| {
        for result in results {
            outputs.push(Values { shape: result.shape().to_vec(), values: result.values::<f32>()?.to_vec() });
        }
        Ok(())
    })?;
    Ok(outputs)
}

/// Returns the largest difference as a share of the largest magnitude; infinite where there is a NaN or sizes differ.
fn difference(ours: &Values, burn: &Values) -> f32 {
    if ours.shape != burn.shape {
        return f32::INFINITY;
    }
    let magnitude = burn.values.iter().fold(f32::MIN_POSITIVE, |largest, value| largest.max(value.abs()));
    let apart = ours.values.iter().zip(&burn.values).map(|(a, b)| (a - b).abs() / magnitude);
    apart.fold(0.0, |largest, apart| if apart.is_nan() { f32::INFINITY } else { largest.max(apart) })
}

/// Returns the differences, one line each.
fn disagreements(runtime: &dyn Runtime) -> Vec<String> {
    let _turn = crate::turn();
    let mut wrong = Vec::new();
    for case in architectures::all() {
        for (kind, run) in [("fixed", &case.fixed), ("open", &case.open)] {
            let what = format!("{} ({kind}) in {}", case.name, runtime.name());
            match outputs(runtime, run) {
                Err(error) => wrong.push(format!("{what}: {error:#}")),
                Ok(outputs) => {
                    assert_eq!(outputs.len(), run.outputs.len(), "{what}");
                    for (index, (ours, burn)) in outputs.iter().zip(&run.outputs).enumerate() {
                        let difference = difference(ours, burn);
                        if difference > TOLERANCE {
                            let sizes = (&ours.shape, &burn.shape);
                            wrong.push(format!(
                                "{what}: output {index} differs by {difference:.1e}, sizes {sizes:?}"
                            ));
                        }
                    }
                }
            }
        }
    }
    wrong
}

#[test]
fn the_builtin_runtime_equals_burn() {
    let wrong = disagreements(&Builtin);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn onnx_runtime_equals_burn() {
    let onnx_runtime =
        OnnxRuntime::find().expect("set ORT_DYLIB_PATH to the library of ONNX Runtime 1.23 or later");
    let wrong = disagreements(&*onnx_runtime);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
