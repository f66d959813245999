//! Inputs on which a learner is measured.

use std::path::{Path, PathBuf};

use clap::ArgMatches;
use opendr::data::Audio;
use opendr::datasets::{open_value, value_extensions};
use opendr::learner::{Entry, Port};
use opendr::model::Model;
use opendr::resampler::resampled;
use opendr::zoo::ItemKind;
use opendr::{Error, Progress as _, Result, Value, ValueType, vision};
use serde::Serialize;
use serde_json::{Map, Value as Json};

use super::synthetic;
use crate::progress_bar::ProgressBar;
use crate::{learner_flags, loading};

/// Size of sample and synthetic images, in pixels.
const WIDTH: usize = 1920;
const HEIGHT: usize = 1080;
/// Chunks of audio per second, as from a microphone.
const CHUNKS_PER_SECOND: usize = 10;

/// Inputs of a measurement, as serialised in the report.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Workload {
    /// One image, repeated.
    Image { source: String, width: usize, height: usize },
    /// Audio, repeated: whole, or in chunks where the learner is streaming.
    Audio { source: String, sample_rate: u32, chunk_s: f64 },
    /// Values of another type, in turn.
    Values {
        source: String,
        #[serde(rename = "type")]
        value_type: &'static str,
        count: usize,
    },
    /// Observations of the environment with this id.
    Environment(String),
}

/// Values of one port.
pub struct Input {
    pub port: &'static Port,
    pub values: Vec<Value>,
}

/// Returns the values of the learner's ports and the description of the first port's. An optional port has none, unless the user
/// named a file.
///
/// # Errors
/// The error of a file that cannot be read, or `Unsupported` for a type without synthetic values.
pub fn inputs(
    spec: &str,
    entry: &'static Entry,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<(Workload, Vec<Input>)> {
    let Some((first, further)) = entry.ports.split_first() else {
        return Err(Error::unsupported(format!("{spec} has no input port and cannot be measured")));
    };
    let described = manifest_inputs(spec, matches, bar)?;
    let (workload, values) = first_values(first, &described, entry, matches, bar)?;
    let size = match values.first() {
        Some(Value::Image(image)) => [image.width(), image.height()],
        _ => [WIDTH, HEIGHT],
    };
    let mut inputs = vec![Input { port: first, values }];
    let files = learner_flags::port_files(entry, matches)?;
    for port in further {
        let values = match files.iter().find(|file| file.name() == port.name) {
            Some(file) => vec![file.value(0)?],
            None if port.optional && !port.init => continue,
            None => synthetic::values(port, size, &described)?,
        };
        inputs.push(Input { port, values });
    }
    Ok((workload, inputs))
}

fn first_values(
    port: &Port,
    described: &Map<String, Json>,
    entry: &'static Entry,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<(Workload, Vec<Value>)> {
    let kind = port.value_type;
    let (source, values) = match matches.get_one::<PathBuf>("input") {
        Some(path) => (path.display().to_string(), vec![open_value(kind, path)?]),
        None => match sample(kind, matches, bar)? {
            Some((source, Value::Image(image))) => {
                (source, vec![vision::resize(&image, WIDTH, HEIGHT)?.into()])
            }
            Some((source, Value::Audio(audio))) => {
                let rate = described.get(port.name).and_then(|input| input.get("rate")?.as_u64());
                (source, vec![at_rate(audio, rate)?.into()])
            }
            Some((source, value)) => (source, vec![value]),
            None => ("drawn".to_owned(), synthetic::values(port, [WIDTH, HEIGHT], described)?),
        },
    };
    workload(source, values, entry)
}

/// Returns the inputs that the model's manifest describes.
fn manifest_inputs(spec: &str, matches: &ArgMatches, bar: &ProgressBar) -> Result<Map<String, Json>> {
    Ok(Model::open(loading::model(spec, matches, bar)?)?.manifest().inputs.clone())
}

/// Returns mono audio resampled to the model's rate; audio of several channels stays unchanged.
fn at_rate(audio: Audio, rate: Option<u64>) -> Result<Audio> {
    match rate.and_then(|rate| u32::try_from(rate).ok()) {
        Some(rate) if rate != audio.sample_rate() && audio.channels() == 1 => {
            Audio::new(resampled(audio.as_slice(), audio.sample_rate(), rate)?, 1, rate)
        }
        _ => Ok(audio),
    }
}

fn workload(source: String, values: Vec<Value>, entry: &'static Entry) -> Result<(Workload, Vec<Value>)> {
    Ok(match values.first() {
        Some(Value::Image(image)) => {
            (Workload::Image { source, width: image.width(), height: image.height() }, values)
        }
        Some(Value::Audio(audio)) => {
            let chunks = if entry.capabilities.streaming { chunks(audio)? } else { vec![audio.clone()] };
            let chunk_s = chunks.first().map_or(0.0, Audio::duration_s);
            let sample_rate = audio.sample_rate();
            (Workload::Audio { source, sample_rate, chunk_s }, chunks.into_iter().map(Value::Audio).collect())
        }
        first => {
            let value_type = first.map_or("nothing", |value| value.as_value_ref().value_type().name());
            (Workload::Values { source, value_type, count: values.len() }, values)
        }
    })
}

/// Returns the first sample of the zoo of type `kind`; `None` when none can be downloaded.
fn sample(kind: ValueType, matches: &ArgMatches, bar: &ProgressBar) -> Result<Option<(String, Value)>> {
    let zoo = loading::zoo(matches)?;
    let is_of_kind = |name: &str| {
        Path::new(name)
            .extension()
            .is_some_and(|end| value_extensions(kind).iter().any(|known| end.eq_ignore_ascii_case(known)))
    };
    for item in zoo.items().filter(|item| item.card.kind == ItemKind::Sample) {
        if !item.variant.files.iter().any(|file| is_of_kind(&file.name)) {
            continue;
        }
        let name = item.to_string();
        match zoo.get(&name, bar) {
            Ok(path) => return Ok(Some((name, open_value(kind, path)?))),
            Err(error) => bar.note(&format!("measuring on synthetic data: {error}")),
        }
    }
    Ok(None)
}

/// Splits audio into chunks of a tenth of a second; an incomplete last chunk is dropped.
fn chunks(audio: &Audio) -> Result<Vec<Audio>> {
    let length = (audio.sample_rate() as usize / CHUNKS_PER_SECOND).max(1) * audio.channels();
    let chunks = audio.as_slice().chunks_exact(length);
    chunks.map(|chunk| Audio::new(chunk.to_vec(), audio.channels(), audio.sample_rate())).collect()
}
