//! Conversion to version 3.0.

use std::collections::BTreeMap;
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt as _};

use crate::{Info, LeRobotSet, LeRobotWriter, SetOptions};

/// Features that the writer adds.
const WRITTEN: [&str; 5] = ["timestamp", "frame_index", "episode_index", "index", "task_index"];

/// Writes a data set as one of version 3.0 into a new folder: numbers, tasks and videos of the episodes for which `keep` returns true and
/// whose files are present. Pictures within tables and text are left out. `observer` receives the number of episodes that are read.
///
/// Episodes and frames are counted from zero again, and time stamps are those of the frequency.
///
/// # Errors
/// `Unsupported` for a set of version 3.0 with videos, whose files have several episodes; as [`LeRobotSet::read`] and [`LeRobotWriter::add`].
pub fn convert(
    set: &mut LeRobotSet,
    target: &Path,
    keep: &dyn Fn(usize) -> bool,
    observer: &mut dyn FnMut(usize),
) -> Result<Info> {
    if set.info().is_version_3()? && set.info().video_keys().next().is_some() {
        return Err(Error::unsupported("the data set has version 3.0 already; copy its folder"));
    }
    let present = |feature: &str| {
        let mut kept = set.episodes().iter().filter(|record| keep(record.index));
        kept.all(|record| record.videos.get(feature).is_some_and(|video| video.path.exists()))
    };
    let features = set.info().features.iter().filter(|(name, feature)| match feature.is_video() {
        true => present(name),
        false => feature.is_numeric() && !WRITTEN.contains(&name.as_str()),
    });
    let options = SetOptions {
        fps: set.info().fps,
        robot_type: set.info().robot_type.clone(),
        features: features.map(|(name, feature)| (name.clone(), feature.clone())).collect(),
    };
    let mut writer = LeRobotWriter::create(target, &options)?;
    for episode in 0..set.episodes().len() {
        let record = set.episodes()[episode].clone();
        if !keep(record.index) || !record.data.exists() {
            continue;
        }
        let columns = set.read(episode, &|name| options.features.contains_key(name))?;
        let videos = record.videos.into_iter().filter(|(name, _)| options.features.contains_key(name));
        let videos: BTreeMap<_, _> = videos.map(|(name, video)| (name, video.path)).collect();
        let task = record.tasks.first().map_or("", String::as_str);
        writer.add(&columns, task, &videos).context(|| format!("episode {}", record.index))?;
        observer(episode + 1);
    }
    writer.finish()
}
