//! Writing of data sets of version 3.0.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt as _};
use serde_json::Value;

use crate::metadata::{CHUNK, episode_columns, tasks_index, write_json, write_table};
use crate::record::{EpisodeRecord, VideoSegment};
use crate::table::Table;
use crate::table_writer::TableWriter;
use crate::{Column, Feature, FeatureStatistics, Info, Values};

/// Frequency, robot and features of a new data set.
#[derive(Debug, Clone, PartialEq)]
pub struct SetOptions {
    /// Frames per second.
    pub fps: f64,
    /// Type of the robot; none if there is none.
    pub robot_type: Option<String>,
    /// Features of the frames, without those that every set has: time stamp and indices.
    pub features: BTreeMap<String, Feature>,
}

/// A data set of version 3.0 that is being written; LeRobot can load it after [`Self::finish`].
pub struct LeRobotWriter {
    root: PathBuf,
    info: Info,
    table: Option<TableWriter>,
    /// Number of data files that were begun.
    files: usize,
    episodes: Vec<EpisodeRecord>,
    /// Number of the data file of each episode.
    file_of: Vec<usize>,
    tasks: Vec<String>,
    statistics: BTreeMap<String, FeatureStatistics>,
}

const DATA: &str = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet";
const VIDEO: &str = "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4";
const DATA_MB: u64 = 100;
const VIDEO_MB: u64 = 200;
/// Features that every data set has.
const INDICES: [&str; 4] = ["frame_index", "episode_index", "index", "task_index"];
const TIME: &str = "timestamp";

impl LeRobotWriter {
    /// Creates the data set in a new or empty folder.
    ///
    /// # Errors
    /// `InvalidInput` for a folder with files, and for a frequency or feature that is not possible; `Io`.
    pub fn create(root: &Path, options: &SetOptions) -> Result<Self> {
        if root.read_dir().is_ok_and(|mut entries| entries.next().is_some()) {
            return Err(Error::invalid_input(format!(
                "{} is not empty; write the data set into a new folder",
                root.display()
            )));
        }
        if !options.fps.is_finite() || options.fps <= 0.0 {
            return Err(Error::invalid_input(format!("fps is {}; give a positive number", options.fps)));
        }
        for (name, feature) in &options.features {
            let reserved = name == TIME || INDICES.contains(&name.as_str());
            let plain = !name.is_empty() && !name.contains(['/', '\\', '{', '}']) && !name.contains("..");
            if reserved || !plain {
                return Err(Error::invalid_input(format!(
                    "{name:?} is no name of a feature; use one as observation.state, without slashes"
                )));
            }
            feature.width().context(|| name.clone())?;
        }
        std::fs::create_dir_all(root.join("meta")).context(|| root.display().to_string())?;
        let mut features = options.features.clone();
        features.insert(TIME.to_owned(), Feature::new("float32", vec![1], &[]));
        for name in INDICES {
            features.insert(name.to_owned(), Feature::new("int64", vec![1], &[]));
        }
        let videos = features.values().any(Feature::is_video);
        let sizes = [("data_files_size_in_mb", DATA_MB), ("video_files_size_in_mb", VIDEO_MB)];
        let info = Info {
            codebase_version: "v3.0".to_owned(),
            robot_type: options.robot_type.clone(),
            total_episodes: 0,
            total_frames: 0,
            total_tasks: 0,
            chunks_size: CHUNK,
            fps: options.fps,
            splits: BTreeMap::new(),
            data_path: DATA.to_owned(),
            video_path: videos.then(|| VIDEO.to_owned()),
            features,
            other: sizes.map(|(name, size)| (name.to_owned(), Value::from(size))).into_iter().collect(),
        };
        Ok(Self {
            root: root.to_owned(),
            info,
            table: None,
            files: 0,
            episodes: Vec::new(),
            file_of: Vec::new(),
            tasks: Vec::new(),
            statistics: BTreeMap::new(),
        })
    }

    /// Sets a further entry of `meta/info.json`.
    #[must_use]
    pub fn with_entry(mut self, key: &str, value: Value) -> Self {
        self.info.other.insert(key.to_owned(), value);
        self
    }

    /// Adds an episode: a column per feature that is no video, with one row per frame, and a video file per video, which is copied.
    ///
    /// # Errors
    /// `InvalidInput` for columns and videos that are not those of the features, or have other types or shapes; `Io`.
    pub fn add(&mut self, columns: &Table, task: &str, videos: &BTreeMap<String, PathBuf>) -> Result<()> {
        let index = self.episodes.len();
        let length = self.check(columns, videos).context(|| format!("episode {index}"))?;
        let task_index = self.tasks.iter().position(|known| known == task).unwrap_or_else(|| {
            self.tasks.push(task.to_owned());
            self.tasks.len() - 1
        });
        let mut rows = columns.clone();
        let times = (0..length).map(|frame| (frame as f64 / self.info.fps) as f32).collect();
        rows.insert(TIME.to_owned(), Column::scalars(Values::Float32(times)));
        let first = self.info.total_frames;
        let indices: [Vec<i64>; 4] = [
            (0..length as i64).collect(),
            vec![index as i64; length],
            (first as i64..(first + length) as i64).collect(),
            vec![task_index as i64; length],
        ];
        for (name, values) in INDICES.into_iter().zip(indices) {
            rows.insert(name.to_owned(), Column::scalars(Values::Int64(values)));
        }
        let statistics = statistics_of(&rows)?;
        self.write(&rows)?;
        let mut record = EpisodeRecord { index, length, tasks: vec![task.to_owned()], ..Default::default() };
        for (key, from) in videos {
            let place = [("chunk_index", index / CHUNK), ("file_index", index % CHUNK)];
            let path = crate::member::member(&self.root, VIDEO, &place, key)?;
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder).context(|| folder.display().to_string())?;
            }
            std::fs::copy(from, &path).context(|| format!("copying {}", from.display()))?;
            let to = length as f64 / self.info.fps;
            record.videos.insert(key.clone(), VideoSegment { path, from: 0.0, to });
        }
        for (name, own) in &statistics {
            self.statistics.entry(name.clone()).or_default().merge(own);
        }
        record.statistics = statistics;
        self.episodes.push(record);
        self.file_of.push(self.files - 1);
        self.info.total_frames += length;
        Ok(())
    }

    /// Returns the number of frames of an episode.
    fn check(&self, columns: &Table, videos: &BTreeMap<String, PathBuf>) -> Result<usize> {
        let mut length = None;
        let own = self.info.features.iter().filter(|(name, feature)| {
            !feature.is_video() && *name != TIME && !INDICES.contains(&name.as_str())
        });
        let names: BTreeSet<_> = own.clone().map(|(name, _)| name).collect();
        if let Some(name) = columns.keys().find(|name| !names.contains(name)) {
            return Err(Error::invalid_input(format!("{name:?} is no feature of the data set")));
        }
        for (name, feature) in own {
            let column = columns
                .get(name)
                .ok_or_else(|| Error::invalid_input(format!("there is no column of the feature {name:?}")))?;
            let (dtype, width) = (column.values.dtype(), column.width()?);
            let is_list = feature.shape != [1];
            if dtype != feature.dtype || width != feature.width()? || column.lengths.is_some() != is_list {
                return Err(Error::invalid_input(format!(
                    "{name:?} has rows of {width} values of {dtype}; the feature has shape {:?} and type {}",
                    feature.shape, feature.dtype
                )));
            }
            if *length.get_or_insert(column.rows()) != column.rows() {
                return Err(Error::invalid_input(format!("{name:?} has another number of rows than others")));
            }
        }
        let wanted: BTreeSet<_> = self.info.video_keys().collect();
        if wanted != videos.keys().map(String::as_str).collect::<BTreeSet<_>>() {
            return Err(Error::invalid_input(format!("the videos must be those of {wanted:?}")));
        }
        length.filter(|&length| length > 0).ok_or_else(|| Error::invalid_input("the episode has no frames"))
    }

    /// Writes the rows to the current data file, or to a new one if that is full.
    fn write(&mut self, rows: &Table) -> Result<()> {
        let columns: Vec<_> = rows.iter().map(|(name, column)| (name.as_str(), column)).collect();
        let mut table = match self.table.take() {
            Some(table) if table.bytes() < DATA_MB << 20 => table,
            full => {
                full.map_or(Ok(()), TableWriter::finish)?;
                let place = [("chunk_index", self.files / CHUNK), ("file_index", self.files % CHUNK)];
                let path = crate::member::member(&self.root, DATA, &place, "")?;
                self.files += 1;
                TableWriter::create(&path, &columns, None)?
            }
        };
        table.add(&columns)?;
        self.table = Some(table);
        Ok(())
    }

    /// Completes the data set: tables of tasks and episodes, statistics and description. Returns the description.
    ///
    /// # Errors
    /// `InvalidInput` without an episode; `Io`.
    pub fn finish(mut self) -> Result<Info> {
        if self.episodes.is_empty() {
            return Err(Error::invalid_input("the data set has no episode; add one"));
        }
        self.table.take().map_or(Ok(()), TableWriter::finish)?;
        self.info.total_episodes = self.episodes.len();
        self.info.total_tasks = self.tasks.len();
        self.info.splits.insert("train".to_owned(), format!("0:{}", self.episodes.len()));
        let meta = self.root.join("meta");
        let tasks = Column::scalars(Values::Text(self.tasks.clone()));
        let indices = Column::scalars(Values::Int64((0..self.tasks.len() as i64).collect()));
        write_table(
            &meta.join("tasks.parquet"),
            &[("task_index", &indices), ("task", &tasks)],
            Some(tasks_index().to_string()),
        )?;
        let columns = episode_columns(&self.info, &self.episodes, &self.file_of);
        let columns: Vec<_> = columns.iter().map(|(name, column)| (name.as_str(), column)).collect();
        write_table(&meta.join("episodes/chunk-000/file-000.parquet"), &columns, None)?;
        write_json(&meta.join("stats.json"), &self.statistics)?;
        write_json(&meta.join("info.json"), &self.info)?;
        Ok(self.info)
    }
}

fn statistics_of(rows: &Table) -> Result<BTreeMap<String, FeatureStatistics>> {
    let numeric = rows.iter().filter(|(_, column)| !matches!(column.values, Values::Text(_)));
    numeric
        .map(|(name, column)| Ok((name.clone(), FeatureStatistics::of(&column.numbers()?, column.width()?))))
        .collect()
}
