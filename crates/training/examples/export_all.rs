//! Writes every architecture of the tests into a folder, for the comparisons in tests/training: the models, inputs with Burn's
//! outputs (JSON), and the parameters (safetensors).

#[path = "../tests/suite/architectures/mod.rs"]
mod architectures;

use std::error::Error;
use std::path::Path;

use architectures::case::{Run, Values};
use serde_json::{Value, json};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: export_all FOLDER")?;
    let folder = Path::new(&folder);
    for case in architectures::all() {
        for (kind, run) in [("fixed", case.fixed), ("open", case.open)] {
            let file = folder.join(format!("{}_{kind}", case.name));
            std::fs::write(file.with_extension("json"), json_from_run(&run))?;
            std::fs::write(file.with_extension("onnx"), run.model?)?;
        }
        std::fs::write(folder.join(format!("{}.safetensors", case.name)), &case.parameters)?;
    }
    Ok(())
}

fn json_from_run(run: &Run) -> String {
    let outputs: Vec<Value> = run.outputs.iter().map(json_from_values).collect();
    json!({ "input": json_from_values(&run.input), "outputs": outputs }).to_string()
}

fn json_from_values(values: &Values) -> Value {
    json!({ "shape": values.shape, "values": values.values })
}
