//! `run_rten model.onnx input.bin 1,3,512,512 out`: runs a model with one float input on the pure-Rust runtime. Files
//! contain raw little-endian float32; `out.json` lists the outputs' names and shapes, `out.bin` contains them one
//! after the other.

use std::error::Error;

use rten::{Model, Value};
use rten_tensor::Tensor;
use rten_tensor::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, input, dims, out] = arguments.as_slice() else {
        return Err("usage: run_rten model.onnx input.bin DIM,DIM,... out".into());
    };
    let dims = dims.split(',').map(str::parse).collect::<Result<Vec<usize>, _>>()?;
    let bytes = std::fs::read(input)?;
    let values = bytes.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect::<Vec<_>>();
    let model = Model::load_file(model)?;
    let input = Tensor::from_data(&dims, values);
    let outputs = model.run(vec![(model.input_ids()[0], input.view().into())], model.output_ids(), None)?;
    let (mut listed, mut raw) = (Vec::new(), Vec::new());
    for (id, output) in model.output_ids().iter().zip(outputs) {
        let name = model.node_info(*id).and_then(|info| info.name()).unwrap_or_default().to_owned();
        let (dims, values): (Vec<usize>, Vec<f32>) = match output {
            Value::FloatTensor(tensor) => (tensor.shape().to_vec(), tensor.to_vec()),
            Value::Int32Tensor(tensor) => {
                (tensor.shape().to_vec(), tensor.iter().map(|&value| value as f32).collect())
            }
            other => return Err(format!("output {name} has the unsupported type {:?}", other.dtype()).into()),
        };
        listed.push(serde_json::json!({"name": name, "dims": dims}));
        raw.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    }
    std::fs::write(format!("{out}.json"), serde_json::to_vec(&listed)?)?;
    std::fs::write(format!("{out}.bin"), raw)?;
    Ok(())
}
