//! `run_onnx model.onnx input.bin 1,3,512,512 out`: runs a model with one float input on the graph executor. Files
//! contain raw little-endian float32; `out.json` lists the outputs' names and shapes, `out.bin` contains them one
//! after the other.

use std::error::Error;

use opendr_executor::{Data, Executor, Tensor};
use opendr_kernels::Compute;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, input, dims, out] = arguments.as_slice() else {
        return Err("usage: run_onnx model.onnx input.bin DIM,DIM,... out".into());
    };
    let dims = dims.split(',').map(str::parse).collect::<Result<Vec<usize>, _>>()?;
    let bytes = std::fs::read(input)?;
    let values = bytes.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect::<Vec<_>>();
    let mut executor = Executor::open(&std::fs::read(model)?, Compute::single())?;
    let names: Vec<String> = executor.outputs().map(|(name, _)| name.to_owned()).collect();
    let (mut listed, mut raw) = (Vec::new(), Vec::new());
    let input = Tensor { shape: &dims, data: Data::F32(&values) };
    executor.run(&[input], &mut |outputs| {
        for (name, output) in names.iter().zip(outputs) {
            let values: Vec<f32> = match output.data {
                Data::F32(data) => data.to_vec(),
                Data::I32(data) => data.iter().map(|&value| value as f32).collect(),
                Data::I64(data) => data.iter().map(|&value| value as f32).collect(),
                Data::U8(data) | Data::Bool(data) => data.iter().map(|&value| f32::from(value)).collect(),
                Data::I8(data) => data.iter().map(|&value| f32::from(value)).collect(),
            };
            listed.push(serde_json::json!({"name": name, "dims": output.shape}));
            raw.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        }
        Ok(())
    })?;
    std::fs::write(format!("{out}.json"), serde_json::to_vec(&listed)?)?;
    std::fs::write(format!("{out}.bin"), raw)?;
    Ok(())
}
