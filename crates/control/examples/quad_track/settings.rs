//! What the command line sets.

use opendr_control::online::AdaptationParams;
use opendr_engine::params::{ParamValue, Params as _};
use opendr_engine::{Error, Result};

pub struct Settings {
    pub episodes: u64,
    pub seeds: u64,
    pub plants: u64,
    /// Of the first episode; the defaults of the adaptation were chosen on others.
    pub first_seed: u64,
    /// One case of the protocol alone.
    pub case: Option<usize>,
    pub video: Option<String>,
    /// File to which the base network of seed 0 is written.
    pub policy: Option<String>,
    pub params: AdaptationParams,
    /// Options of the environment for every flight.
    pub plant: Vec<(String, f64)>,
}

impl Settings {
    pub fn parse(arguments: impl Iterator<Item = String>) -> Result<Self> {
        let mut settings = Self {
            episodes: 500,
            seeds: 5,
            plants: 1000,
            first_seed: 1_000_000,
            case: None,
            video: None,
            policy: None,
            params: AdaptationParams::default(),
            plant: Vec::new(),
        };
        for argument in arguments {
            let wrong = || Error::invalid_param(format!("{argument}: give NAME=VALUE, as episodes=20"));
            let (name, text) = argument.split_once('=').ok_or_else(wrong)?;
            let number = text.parse::<f64>();
            let real = || number.clone().map_err(|_| wrong());
            match name {
                "episodes" => settings.episodes = real()? as u64,
                "seeds" => settings.seeds = real()? as u64,
                "plants" => settings.plants = real()? as u64,
                "first_seed" => settings.first_seed = real()? as u64,
                "case" => settings.case = Some(real()? as usize),
                "video" => settings.video = Some(text.to_owned()),
                "policy" => settings.policy = Some(text.to_owned()),
                _ if name.starts_with("plant.") => {
                    settings.plant.push((name["plant.".len()..].to_owned(), real()?));
                }
                _ => {
                    let value = match (number, text.parse::<bool>()) {
                        (Ok(number), _) => ParamValue::Float(number),
                        (_, Ok(flag)) => ParamValue::Bool(flag),
                        _ => ParamValue::Text(text.to_owned()),
                    };
                    settings.params.set(name, value)?;
                }
            }
        }
        Ok(settings)
    }
}
