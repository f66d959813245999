//! What a learner is measured on.

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

use super::drawn;
use crate::progress_bar::Bar;
use crate::{learner_flags, loading};

/// Size of a picture of the zoo or of our own, pixels.
const WIDTH: usize = 1920;
const HEIGHT: usize = 1080;
/// How often a microphone hands on what it heard.
const PIECES_A_SECOND: usize = 10;

/// What was inferred from, as the report names it.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Seen {
    /// One picture, again and again.
    Picture { source: String, width: usize, height: usize },
    /// A sound, from its beginning again and again: whole, or in pieces where the learner takes them.
    Sound { source: String, sample_rate: u32, piece_s: f64 },
    /// Values of another type, one after the other.
    Values { source: String, of: &'static str, count: usize },
    /// What an environment showed in the course of episodes.
    Environment(String),
}

/// The values of one port.
pub struct Input {
    pub port: &'static Port,
    pub values: Vec<Value>,
}

/// The values of the learner's ports, and what the first are. A port that may be left out is, unless the user named a file.
///
/// # Errors
/// What kept a file that the user named from being read, or `Unsupported` for a type that nothing can be drawn of.
pub fn inputs(
    spec: &str,
    entry: &'static Entry,
    matches: &ArgMatches,
    bar: &Bar,
) -> Result<(Seen, Vec<Input>)> {
    let Some((first, further)) = entry.ports.split_first() else {
        return Err(Error::unsupported(format!("{spec} takes nothing that it could be measured on")));
    };
    let described = described(spec, matches, bar)?;
    let (seen, values) = first_values(first, &described, entry, matches, bar)?;
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
            None => drawn::values(port, size, &described)?,
        };
        inputs.push(Input { port, values });
    }
    Ok((seen, inputs))
}

fn first_values(
    port: &Port,
    described: &Map<String, Json>,
    entry: &'static Entry,
    matches: &ArgMatches,
    bar: &Bar,
) -> Result<(Seen, Vec<Value>)> {
    let kind = port.value_type;
    let (source, values) = match matches.get_one::<PathBuf>("input") {
        Some(path) => (path.display().to_string(), vec![open_value(kind, path)?]),
        None => match sample(kind, matches, bar)? {
            Some((source, Value::Image(image))) => {
                (source, vec![vision::resize(&image, WIDTH, HEIGHT)?.into()])
            }
            Some((source, Value::Audio(sound))) => {
                let rate = described.get(port.name).and_then(|input| input.get("rate")?.as_u64());
                (source, vec![at_rate(sound, rate)?.into()])
            }
            Some((source, value)) => (source, vec![value]),
            None => ("drawn".to_owned(), drawn::values(port, [WIDTH, HEIGHT], described)?),
        },
    };
    seen(source, values, entry)
}

/// What the model says of its inputs.
fn described(spec: &str, matches: &ArgMatches, bar: &Bar) -> Result<Map<String, Json>> {
    let container = match matches.get_one::<PathBuf>("model") {
        Some(path) => path.clone(),
        None => loading::pretrained(spec, matches, bar)?,
    };
    Ok(Model::open(&container)?.manifest().inputs.clone())
}

/// A sound of one channel at the rate of the model.
fn at_rate(sound: Audio, rate: Option<u64>) -> Result<Audio> {
    match rate.and_then(|rate| u32::try_from(rate).ok()) {
        Some(rate) if rate != sound.sample_rate() && sound.channels() == 1 => {
            Audio::new(resampled(sound.as_slice(), sound.sample_rate(), rate)?, 1, rate)
        }
        _ => Ok(sound),
    }
}

fn seen(source: String, values: Vec<Value>, entry: &'static Entry) -> Result<(Seen, Vec<Value>)> {
    Ok(match values.first() {
        Some(Value::Image(image)) => {
            (Seen::Picture { source, width: image.width(), height: image.height() }, values)
        }
        Some(Value::Audio(sound)) => {
            let pieces = if entry.capabilities.streaming { pieces(sound)? } else { vec![sound.clone()] };
            let piece_s = pieces.first().map_or(0.0, Audio::duration_s);
            let sample_rate = sound.sample_rate();
            (Seen::Sound { source, sample_rate, piece_s }, pieces.into_iter().map(Value::Audio).collect())
        }
        first => {
            let of = first.map_or("nothing", |value| value.as_value_ref().value_type().name());
            (Seen::Values { source, of, count: values.len() }, values)
        }
    })
}

/// The first sample of the zoo that is a `kind`; none when it cannot be got.
fn sample(kind: ValueType, matches: &ArgMatches, bar: &Bar) -> Result<Option<(String, Value)>> {
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
            Err(error) => bar.note(&format!("measuring on what is drawn, since {error}")),
        }
    }
    Ok(None)
}

/// The sound in pieces of a tenth of a second, as a microphone gives it; the rest at the end is left out.
fn pieces(sound: &Audio) -> Result<Vec<Audio>> {
    let length = (sound.sample_rate() as usize / PIECES_A_SECOND).max(1) * sound.channels();
    let pieces = sound.as_slice().chunks_exact(length);
    pieces.map(|piece| Audio::new(piece.to_vec(), sound.channels(), sound.sample_rate())).collect()
}
