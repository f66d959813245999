//! Demonstrations as data sets of LeRobot.

use std::collections::BTreeMap;
use std::path::Path;

use opendr_engine::environment::{EnvironmentSpec, Space};
use opendr_engine::{Error, Result};
use opendr_lerobot::{Column, Feature, Info, LeRobotSet, LeRobotWriter, SetOptions, Values};
use opendr_rl::SpaceRecord;
use serde::{Deserialize, Serialize};

use crate::demonstrations::{DemonstrationSet, Episode};
use crate::source::Source;

/// Names of the features.
const STATE: &str = "observation.state";
const ACTION: &str = "action";
const OBSERVATION: &str = "observation.";
/// Key of the record of the environment in `meta/info.json`.
const RECORD: &str = "opendr";

/// What OpenDR adds to the description of a data set that it recorded: LeRobot ignores it.
#[derive(Serialize, Deserialize)]
struct EnvironmentRecord {
    environment: String,
    observation: SpaceRecord,
    action: SpaceRecord,
}

/// Writes demonstrations of an environment as a data set of version 3.0 into a new folder, with `fps` steps per second.
///
/// # Errors
/// As [`LeRobotWriter::create`] and [`LeRobotWriter::add`]; `Unsupported` for a space that cannot be stored.
pub fn write_demonstrations(
    set: &DemonstrationSet,
    spec: &EnvironmentSpec,
    fps: f64,
    task: &str,
    target: &Path,
) -> Result<Info> {
    let [observation_len, action_len] = set.row_lengths();
    let feature = |width: usize| Feature::new("float32", vec![width], &[]);
    let options = SetOptions {
        fps,
        robot_type: Some(spec.id.clone()),
        features: BTreeMap::from([
            (STATE.to_owned(), feature(observation_len)),
            (ACTION.to_owned(), feature(action_len)),
        ]),
    };
    let record = EnvironmentRecord {
        environment: spec.id.clone(),
        observation: SpaceRecord::of(&spec.observation)?,
        action: SpaceRecord::of(&spec.action)?,
    };
    let record = serde_json::to_value(record)
        .map_err(|error| Error::internal("the spaces cannot be written as JSON").with_source(error))?;
    let mut writer = LeRobotWriter::create(target, &options)?.with_entry(RECORD, record);
    for episode in set.episodes() {
        let column = |numbers: &[f32], width: usize| {
            let values = Values::Float32(numbers.to_vec());
            if width == 1 { Column::scalars(values) } else { Column::lists(values, width) }
        };
        let columns = BTreeMap::from([
            (STATE.to_owned(), column(&episode.observations, observation_len)),
            (ACTION.to_owned(), column(&episode.actions, action_len)),
        ]);
        writer.add(&columns, task, &BTreeMap::new())?;
    }
    writer.finish()
}

/// Reads the demonstrations of a data set for which `keep` returns true: the numbers of all features whose names begin with
/// `observation.`, in the order of names, and of `action`.
///
/// # Errors
/// As [`LeRobotSet::read`]; `InvalidInput` for a data set without observations or actions.
pub fn read_demonstrations(set: &mut LeRobotSet, keep: &dyn Fn(usize) -> bool) -> Result<DemonstrationSet> {
    let numeric = set.info().features.iter().filter(|(_, feature)| feature.is_numeric());
    let widths = numeric.map(|(name, feature)| Ok((name.clone(), feature.width()?)));
    let widths: BTreeMap<String, usize> = widths.collect::<Result<_>>()?;
    let observed: Vec<_> = widths.iter().filter(|(name, _)| name.starts_with(OBSERVATION)).collect();
    let (Some(&action_len), false) = (widths.get(ACTION), observed.is_empty()) else {
        return Err(Error::invalid_input(format!(
            "{} has no numbers of observations or actions; imitation needs features as {STATE} and {ACTION}",
            set.root().display()
        )));
    };
    let observation_len = observed.iter().map(|(_, width)| **width).sum();
    let mut demonstrations = DemonstrationSet::new([observation_len, action_len])?;
    for index in 0..set.episodes().len() {
        let record = &set.episodes()[index];
        if !keep(record.index) {
            continue;
        }
        let length = record.length;
        let table = set.read(index, &|name| name == ACTION || name.starts_with(OBSERVATION))?;
        let numbers = |name: &str, width: usize| -> Result<Vec<f32>> {
            let column =
                table.get(name).ok_or_else(|| Error::format(format!("episode {index} has no {name:?}")))?;
            let numbers: Vec<f32> = column.numbers()?.into_iter().map(|x| x as f32).collect();
            match column.width()? == width && numbers.len() == length * width {
                true => Ok(numbers),
                false => Err(Error::format(format!(
                    "{name:?} of episode {index} has not {width} numbers per frame"
                ))),
            }
        };
        let parts = observed.iter().map(|(name, width)| Ok((numbers(name, **width)?, **width)));
        let parts = parts.collect::<Result<Vec<_>>>()?;
        let mut observations = Vec::with_capacity(length * observation_len);
        for frame in 0..length {
            for (numbers, width) in &parts {
                observations.extend_from_slice(&numbers[frame * width..(frame + 1) * width]);
            }
        }
        demonstrations.add(Episode { observations, actions: numbers(ACTION, action_len)? })?;
    }
    Ok(demonstrations)
}

/// Reads a data set for a training: its episodes whose tables are present, and the spaces of the environment that it was recorded in,
/// if it states one.
///
/// # Errors
/// As [`LeRobotSet::open`] and [`read_demonstrations`].
pub(crate) fn read_source(path: &Path) -> Result<Source> {
    let mut set = LeRobotSet::open(path)?;
    let present: Vec<bool> = set.episodes().iter().map(|record| record.data.exists()).collect();
    let indices: BTreeMap<usize, bool> =
        set.episodes().iter().map(|record| record.index).zip(present).collect();
    let demonstrations = read_demonstrations(&mut set, &|index| indices.get(&index) == Some(&true))?;
    let record = set.info().other.get(RECORD).cloned().map(serde_json::from_value).transpose();
    let record: Option<EnvironmentRecord> = record
        .map_err(|error| Error::format("the record of the environment is damaged").with_source(error))?;
    let (spaces, environment) = match record {
        Some(record) => {
            let spaces = [record.observation.space(), record.action.space()];
            let [observation, action] = spaces;
            let spaces = [observation?, action?];
            if [spaces[0].len(), spaces[1].len()] != demonstrations.row_lengths() {
                return Err(Error::format("the record of the environment is that of other demonstrations"));
            }
            (spaces, Some(record.environment))
        }
        None => {
            let spaces =
                demonstrations.row_lengths().map(|width| Space::symmetric(&vec![f32::INFINITY; width]));
            (spaces, None)
        }
    };
    if demonstrations.episodes().is_empty() {
        return Err(Error::invalid_input(format!("{} has no episode", path.display())));
    }
    Ok(Source { set: demonstrations, spaces, environment })
}
