//! The options of the command line.

use std::ops::Range;

use opendr_active::FIRST_EVALUATION_SEED;
use opendr_engine::{Error, Result};
use opendr_simulation::sphere_view::Subject;

pub struct Options {
    pub subject: Subject,
    /// Seeds of the trainings of camera policies.
    pub seeds: Range<u64>,
    pub timesteps: u64,
    pub episodes: u64,
    pub view_episodes: u64,
    /// First seed of the episodes that compare camera policies.
    pub first_seed: u64,
    pub strip: Option<String>,
    /// Folder of a trained model.
    pub model: Option<String>,
}

impl Options {
    pub fn parse() -> Result<Self> {
        let mut options = Self {
            subject: Subject::Face,
            seeds: 0..1,
            timesteps: 400_000,
            episodes: 500,
            view_episodes: 12_000,
            first_seed: FIRST_EVALUATION_SEED,
            strip: None,
            model: None,
        };
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            if let Some(subject) = Subject::ALL.into_iter().find(|subject| subject.name() == argument) {
                options.subject = subject;
                continue;
            }
            let value = arguments.next();
            let value = value.ok_or_else(|| Error::invalid_param(format!("give {argument} a value")))?;
            let number = || {
                let number = value.parse().ok();
                number.ok_or_else(|| Error::invalid_param(format!("give {argument} a number")))
            };
            match argument.as_str() {
                "--seeds" => options.seeds = range(&value)?,
                "--timesteps" => options.timesteps = number()?,
                "--episodes" => options.episodes = number()?,
                "--view-episodes" => options.view_episodes = number()?,
                "--first-seed" => options.first_seed = number()?,
                "--strip" => options.strip = Some(value),
                "--model" => options.model = Some(value),
                _ => {
                    return Err(Error::invalid_param(format!(
                        "no option {argument:?}; give face, object or pose, and --seeds, --timesteps, --episodes, --view-episodes, --first-seed, --model or --strip"
                    )));
                }
            }
        }
        Ok(options)
    }
}

/// Parses `5`, the seeds 0 to 4, or `2..5`.
fn range(text: &str) -> Result<Range<u64>> {
    let (first, end) = text.split_once("..").unwrap_or(("0", text));
    match (first.parse(), end.parse()) {
        (Ok(first), Ok(end)) => Ok(first..end),
        _ => Err(Error::invalid_param(format!("--seeds {text:?}; give a number, or a range such as 2..5"))),
    }
}
