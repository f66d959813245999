//! Runs any learner by name and prints the outputs of each call as one line of JSON.
//!
//! ```console
//! $ cargo run --release --example infer_json -- nanodet '{"threshold": 0.5}' image=street.jpg
//! $ cargo run --release --example infer_json -- tracker=models/mine '{}' image=1.png detections=@1.json , image=2.png detections=@2.json
//! ```
//!
//! The learner is a name of the registry, with `/VARIANT` or `=CONTAINER`; then its parameters as JSON; then the inputs:
//! `PORT=PICTURE` or `PORT=@TARGET.json`, with a comma between the calls of one stream.

use std::collections::BTreeMap;
use std::error::Error;
use std::{env, fs};

use opendr::learner::{AnyLearner, Outputs, Ports};
use opendr::params::ParamMap;
use opendr::{Device, Silent, Value};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    #[cfg(feature = "test-learner")]
    if let [flag, folder] = &arguments[..]
        && flag == "--write-counter"
    {
        return Ok(opendr::learner::counter::write_model(folder.as_ref(), 5, &ParamMap::new())?);
    }
    let [learner, params, inputs @ ..] = &arguments[..] else {
        return Err("give a learner, parameters as JSON, and inputs as PORT=FILE".into());
    };
    let mut learner = load(learner, &serde_json::from_str(params)?)?;
    for call in inputs.split(|word| word == ",") {
        let values = call.iter().map(|word| read(word)).collect::<Result<Vec<_>, _>>()?;
        let ports = values
            .iter()
            .fold(Ports::default(), |ports, (name, value)| ports.with(name, value.as_value_ref()));
        println!("{}", json(&learner.infer(&ports)?)?);
    }
    Ok(())
}

fn load(name: &str, params: &ParamMap) -> opendr::Result<Box<dyn AnyLearner>> {
    let Some((name, container)) = name.split_once('=') else {
        return opendr::learner_with(name, params, Device::Auto, &Silent);
    };
    let mut learner = opendr::registry().find(name)?.make(params, Device::Auto)?;
    learner.load(container.as_ref())?;
    Ok(learner)
}

/// The name of a port and what goes into it.
fn read(word: &str) -> Result<(&str, Value), Box<dyn Error>> {
    let (port, file) = word.split_once('=').ok_or("inputs are PORT=FILE")?;
    let value = match file.strip_prefix('@') {
        Some(file) => serde_json::from_slice(&fs::read(file)?)?,
        None => Value::Image(opendr::vision::open(file)?),
    };
    Ok((port, value))
}

fn json(outputs: &Outputs) -> serde_json::Result<String> {
    serde_json::to_string(&outputs.iter().collect::<BTreeMap<_, _>>())
}
