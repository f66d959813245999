//! Runs any learner by name and prints the outputs of each call as one line of JSON.
//!
//! ```console
//! $ cargo run --release --example infer_json -- nanodet '{"threshold": 0.5}' image=street.jpg
//! $ cargo run --release --example infer_json -- tracker=models/mine '{}' image=1.png detections=1.json , image=2.png detections=2.json
//! ```
//!
//! The learner is a name of the registry, with `/VARIANT` or `=CONTAINER`; then its parameters as JSON; then the inputs:
//! `PORT=FILE` with an image, audio, time series, point cloud, or the JSON of a target, by the type of the port, with a comma
//! between the calls of one stream. With `--seconds` before all that, a last line lists the duration of each call.

use std::collections::BTreeMap;
use std::env;
use std::error::Error;
use std::time::Instant;

use opendr::learner::{AnyLearner, Outputs, Port, Ports};
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
    let is_timed = arguments.first().is_some_and(|flag| flag == "--seconds");
    let [name, params, inputs @ ..] = &arguments[usize::from(is_timed)..] else {
        return Err("give a learner, parameters as JSON, and inputs as PORT=FILE".into());
    };
    let mut seconds = Vec::new();
    let mut learner = load(name, &serde_json::from_str(params)?)?;
    let ports = opendr::registry().find(learner_name(name))?.ports;
    for call in inputs.split(|word| word == ",") {
        let values = call.iter().map(|word| read(word, ports)).collect::<Result<Vec<_>, _>>()?;
        let ports = values
            .iter()
            .fold(Ports::default(), |ports, (name, value)| ports.with(name, value.as_value_ref()));
        let begun = Instant::now();
        let outputs = learner.infer(&ports)?;
        seconds.push(begun.elapsed().as_secs_f64());
        println!("{}", json(&outputs)?);
    }
    if is_timed {
        println!("{}", serde_json::to_string(&seconds)?);
    }
    Ok(())
}

/// Returns the name without `/VARIANT` and `=CONTAINER`.
fn learner_name(name: &str) -> &str {
    name.split(['/', '=']).next().unwrap_or(name)
}

fn load(name: &str, params: &ParamMap) -> opendr::Result<Box<dyn AnyLearner>> {
    let Some((name, container)) = name.split_once('=') else {
        return opendr::learner_with(name, params, Device::Auto, &Silent);
    };
    let mut learner = opendr::registry().find(name)?.make(params, Device::Auto)?;
    learner.load(container.as_ref())?;
    Ok(learner)
}

/// Parses `PORT=FILE` into the name of a port and its value.
fn read<'a>(word: &'a str, ports: &[Port]) -> Result<(&'a str, Value), Box<dyn Error>> {
    let (name, file) = word.split_once('=').ok_or("inputs are PORT=FILE")?;
    let port = ports.iter().find(|port| port.name == name).ok_or_else(|| format!("no input {name:?}"))?;
    Ok((name, opendr::datasets::open_value(port.value_type, file)?))
}

fn json(outputs: &Outputs) -> serde_json::Result<String> {
    serde_json::to_string(&outputs.iter().collect::<BTreeMap<_, _>>())
}
