//! What a learner is measured on.

use std::path::{Path, PathBuf};

use clap::ArgMatches;
use opendr::data::Audio;
use opendr::datasets::{open_value, value_extensions};
use opendr::learner::Entry;
use opendr::model::Model;
use opendr::zoo::ItemKind;
use opendr::{Progress as _, Result, Value, ValueType, vision};
use serde::Serialize;

use super::drawn;
use crate::loading;
use crate::progress_bar::Bar;

/// Size of a picture of the zoo or of our own, pixels.
pub const WIDTH: usize = 1920;
pub const HEIGHT: usize = 1080;
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

/// The values of the learner's first port and what they are.
///
/// # Errors
/// What kept the file that the user named from being read, or `Unsupported` for a type that nothing can be drawn of.
pub fn values(
    spec: &str,
    entry: &'static Entry,
    matches: &ArgMatches,
    bar: &Bar,
) -> Result<(Seen, Vec<Value>)> {
    let kind = entry.ports.first().map_or(ValueType::Image, |port| port.value_type);
    let (source, value) = match matches.get_one::<PathBuf>("input") {
        Some(path) => (path.display().to_string(), open_value(kind, path)?),
        None => match sample(kind, matches, bar)? {
            Some((source, Value::Image(image))) => (source, vision::resize(&image, WIDTH, HEIGHT)?.into()),
            Some(found) => found,
            None => return drawn_values(spec, kind, entry, matches, bar),
        },
    };
    seen(source, vec![value], entry)
}

fn drawn_values(
    spec: &str,
    kind: ValueType,
    entry: &'static Entry,
    matches: &ArgMatches,
    bar: &Bar,
) -> Result<(Seen, Vec<Value>)> {
    let container = match matches.get_one::<PathBuf>("model") {
        Some(path) => path.clone(),
        None => loading::pretrained(spec, matches, bar)?,
    };
    let inputs = Model::open(&container)?.manifest().inputs.clone();
    seen("drawn".to_owned(), drawn::values(kind, &inputs)?, entry)
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
