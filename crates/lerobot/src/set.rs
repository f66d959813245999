//! Reading of data sets.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt as _};
use serde::Deserialize;

use crate::json_lines::read_lines;
use crate::member::member;
use crate::record::{EpisodeRecord, VideoSegment};
use crate::table::{Table, read_table};
use crate::{Column, Info, Values};

/// A data set of LeRobot, of version 2.0, 2.1 or 3.0.
#[derive(Debug, Clone)]
pub struct LeRobotSet {
    root: PathBuf,
    info: Info,
    episodes: Vec<EpisodeRecord>,
    tasks: BTreeMap<usize, String>,
    /// The table that the last episode was read from.
    last: Option<(PathBuf, Table)>,
}

/// A line of `meta/episodes.jsonl`.
#[derive(Deserialize)]
struct EpisodeLine {
    episode_index: usize,
    #[serde(default)]
    tasks: Vec<String>,
    length: usize,
}

/// A line of `meta/tasks.jsonl`.
#[derive(Deserialize)]
struct TaskLine {
    task_index: usize,
    task: String,
}

impl LeRobotSet {
    /// Opens the data set in a folder; tables of frames are read later.
    ///
    /// # Errors
    /// `NotFound` where the folder is no data set; `Format` for damaged files, `Unsupported` for other versions.
    pub fn open(root: &Path) -> Result<Self> {
        let path = root.join("meta/info.json");
        let text = std::fs::read_to_string(&path)
            .context(|| format!("{} is no data set of LeRobot: it needs meta/info.json", root.display()))?;
        let info: Info = serde_json::from_str(&text)
            .map_err(|error| Error::format(format!("{} is damaged", path.display())).with_source(error))?;
        if !info.fps.is_finite() || info.fps <= 0.0 || info.chunks_size == 0 {
            return Err(Error::format(format!(
                "{}: fps is {} and chunks_size {}; both must be positive",
                path.display(),
                info.fps,
                info.chunks_size
            )));
        }
        let mut set =
            Self { root: root.to_owned(), info, episodes: Vec::new(), tasks: BTreeMap::new(), last: None };
        match set.info.is_version_3()? {
            true => set.read_version_3()?,
            false => set.read_version_2()?,
        }
        Ok(set)
    }

    /// Returns the folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Returns the description.
    pub fn info(&self) -> &Info {
        &self.info
    }

    /// Returns the episodes.
    pub fn episodes(&self) -> &[EpisodeRecord] {
        &self.episodes
    }

    /// Returns the tasks by index.
    pub fn tasks(&self) -> &BTreeMap<usize, String> {
        &self.tasks
    }

    /// Reads the features of an episode that are `wanted` and no pictures, one row per frame.
    ///
    /// # Errors
    /// `NotFound` past the last episode and for a missing file; `Format` for a damaged table, or one of other rows than the description
    /// states.
    pub fn read(&mut self, episode: usize, wanted: &dyn Fn(&str) -> bool) -> Result<Table> {
        let record = self.episodes.get(episode).ok_or_else(|| {
            Error::not_found(format!("no episode {episode}; the data set has {}", self.episodes.len()))
        })?;
        let (index, length, path) = (record.index, record.length, record.data.clone());
        let table = match self.last.take() {
            Some((last, table)) if last == path => table,
            _ => read_table(&path, &|name| {
                name == EPISODE || self.info.features.get(name).is_some_and(|feature| feature.is_numeric())
            })?,
        };
        let cut = cut(&table, index, length, wanted).context(|| path.display().to_string());
        self.last = Some((path, table));
        cut
    }

    fn read_version_2(&mut self) -> Result<()> {
        let meta = self.root.join("meta");
        for TaskLine { task_index, task } in read_lines(&meta.join("tasks.jsonl"))? {
            self.tasks.insert(task_index, task);
        }
        for EpisodeLine { episode_index: index, tasks, length } in read_lines(&meta.join("episodes.jsonl"))? {
            let numbers = [("episode_chunk", index / self.info.chunks_size), ("episode_index", index)];
            let data = member(&self.root, &self.info.data_path, &numbers, "")?;
            let mut videos = BTreeMap::new();
            if let Some(pattern) = &self.info.video_path {
                for key in self.info.video_keys() {
                    let path = member(&self.root, pattern, &numbers, key)?;
                    let to = length as f64 / self.info.fps;
                    videos.insert(key.to_owned(), VideoSegment { path, from: 0.0, to });
                }
            }
            let statistics = BTreeMap::new();
            self.episodes.push(EpisodeRecord { index, length, tasks, data, videos, statistics });
        }
        Ok(())
    }

    fn read_version_3(&mut self) -> Result<()> {
        let tasks = read_table(&self.root.join("meta/tasks.parquet"), &|_| true)?;
        let indices = column(&tasks, "task_index")?.counts()?;
        let text = tasks.values().find_map(|column| match &column.values {
            Values::Text(text) if text.len() == indices.len() => Some(text),
            _ => None,
        });
        let text = text.ok_or_else(|| Error::format("meta/tasks.parquet has no column of tasks"))?;
        self.tasks = indices.into_iter().zip(text.iter().cloned()).collect();
        for path in tables_in(&self.root.join("meta/episodes"))? {
            let table = read_table(&path, &|name| !name.starts_with("stats/"))?;
            self.add_episodes(&table).context(|| path.display().to_string())?;
        }
        Ok(())
    }

    fn add_episodes(&mut self, table: &Table) -> Result<()> {
        let counts = |name: &str| column(table, name)?.counts().context(|| name.to_owned());
        let [indices, lengths, chunks, files] =
            ["episode_index", "length", "data/chunk_index", "data/file_index"].map(counts);
        let (indices, lengths, chunks, files) = (indices?, lengths?, chunks?, files?);
        let mut tasks = table.get("tasks").map(texts).transpose()?.unwrap_or_default().into_iter();
        let mut videos = Vec::new();
        for key in self.info.video_keys().filter(|_| self.info.video_path.is_some()) {
            let own = |name: &str| format!("videos/{key}/{name}");
            let times = |name: &str| column(table, &own(name))?.numbers();
            let (chunk, file) = (counts(&own("chunk_index"))?, counts(&own("file_index"))?);
            videos.push((key, chunk, file, times("from_timestamp")?, times("to_timestamp")?));
        }
        let equal = |count: usize| match count == indices.len() {
            true => Ok(()),
            false => Err(Error::format("the columns of episodes have different lengths")),
        };
        [lengths.len(), chunks.len(), files.len()].into_iter().try_for_each(equal)?;
        videos
            .iter()
            .flat_map(|(_, chunk, file, from, to)| [chunk.len(), file.len(), from.len(), to.len()])
            .try_for_each(equal)?;
        for (row, &index) in indices.iter().enumerate() {
            let place = [("chunk_index", chunks[row]), ("file_index", files[row])];
            let data = member(&self.root, &self.info.data_path, &place, "")?;
            let mut segments = BTreeMap::new();
            for (key, chunk, file, from, to) in &videos {
                let place = [("chunk_index", chunk[row]), ("file_index", file[row])];
                let pattern = self.info.video_path.as_deref().unwrap_or_default();
                let path = member(&self.root, pattern, &place, key)?;
                segments.insert((*key).to_owned(), VideoSegment { path, from: from[row], to: to[row] });
            }
            self.episodes.push(EpisodeRecord {
                index,
                length: lengths[row],
                tasks: tasks.next().unwrap_or_default(),
                data,
                videos: segments,
                statistics: BTreeMap::new(),
            });
        }
        Ok(())
    }
}

const EPISODE: &str = "episode_index";

fn column<'t>(table: &'t Table, name: &str) -> Result<&'t Column> {
    table.get(name).ok_or_else(|| Error::format(format!("there is no column {name:?}")))
}

/// Returns the texts of each row.
fn texts(column: &Column) -> Result<Vec<Vec<String>>> {
    let Values::Text(values) = &column.values else {
        return Err(Error::format("the tasks of episodes are no text"));
    };
    let mut rest = values.iter().cloned();
    let ones = vec![1; values.len()];
    let lengths = column.lengths.as_ref().unwrap_or(&ones);
    Ok(lengths.iter().map(|&length| rest.by_ref().take(length).collect()).collect())
}

/// Returns the rows of an episode.
fn cut(table: &Table, index: usize, length: usize, wanted: &dyn Fn(&str) -> bool) -> Result<Table> {
    let episodes = column(table, EPISODE)?.counts()?;
    let first = episodes.iter().position(|&episode| episode == index);
    let rows = first.map(|first| first..first.saturating_add(length));
    let rows = rows.filter(|rows| {
        let own = episodes.get(rows.clone()).is_some_and(|own| own.iter().all(|&episode| episode == index));
        own && episodes.get(rows.end) != Some(&index)
    });
    let rows = rows.ok_or_else(|| {
        Error::format(format!("the table has not the {length} frames of episode {index}; download it again"))
    })?;
    let own = table.iter().filter(|(name, _)| wanted(name));
    own.map(|(name, column)| {
        let cut = column.slice(rows.clone()).context(|| format!("feature {name:.80?}"))?;
        Ok((name.clone(), cut))
    })
    .collect()
}

/// Returns the tables in the folders of a folder, in order.
fn tables_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let list = |folder: &Path| -> Result<Vec<PathBuf>> {
        let entries = std::fs::read_dir(folder).context(|| folder.display().to_string())?;
        let paths = entries.map(|entry| Ok(entry.context(|| folder.display().to_string())?.path()));
        let mut paths = paths.collect::<Result<Vec<_>>>()?;
        paths.sort();
        Ok(paths)
    };
    let mut tables = Vec::new();
    for chunk in list(folder)?.into_iter().filter(|path| path.is_dir()) {
        tables.extend(
            list(&chunk)?.into_iter().filter(|path| path.extension().is_some_and(|e| e == "parquet")),
        );
    }
    Ok(tables)
}
