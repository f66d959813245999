//! Recordings as inputs: each message on the first port's topic is a frame.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::ArgMatches;
use opendr::bags::{Recording, SyncedSet, SyncedSets, is_recording};
use opendr::learner::Entry;
use opendr::vision::{Frame, VideoInfo};
use opendr::{Error, Result, Value};

use super::flags::port_topics;
use crate::item::{Datum, Item, Next};
use crate::recorded_set::RecordedSet;
use crate::report::Report;

/// Frame rate of a recording without a duration, in hertz.
const RATE: f64 = 25.0;

/// Items of several recordings in sequence.
pub struct Recordings {
    waiting: VecDeque<Opened>,
    given: u64,
}

struct Opened {
    recording: Arc<Recording>,
    path: Arc<Path>,
    ports: Vec<&'static str>,
    sets: SyncedSets,
    /// The set after the current one.
    ahead: Option<Result<SyncedSet>>,
    info: Arc<VideoInfo>,
    /// Number of messages on the first port's topic, from the index of the recording.
    messages: u64,
    number: u64,
    reported: bool,
}

impl Recordings {
    /// Opens `inputs` if they are recordings; returns `None` if they are not.
    ///
    /// # Errors
    /// `InvalidInput` for recordings among other inputs; the error of a single recording that cannot be read.
    pub fn open(
        entry: &'static Entry,
        inputs: &[&PathBuf],
        matches: &ArgMatches,
        report: &mut Report<'_>,
    ) -> Result<Option<Self>> {
        let count = inputs.iter().filter(|input| is_recording(input)).count();
        if count == 0 {
            return match matches.contains_id("topic") {
                true => {
                    Err(Error::invalid_param("--topic needs a recording, but no input is one; omit --topic"))
                }
                false => Ok(None),
            };
        }
        if count < inputs.len() {
            let message = "recordings and other inputs cannot be mixed; use one command for each";
            return Err(Error::invalid_input(message));
        }
        let mut waiting = VecDeque::new();
        for input in inputs {
            match Opened::open(entry, input, matches) {
                Ok(opened) => {
                    if !opened.recording.bag().is_complete() {
                        let path = input.display();
                        let message = format!("{path} is truncated or damaged; it is read up to the damage");
                        report.failure(Some(input), &Error::format(message))?;
                    }
                    waiting.push_back(opened);
                }
                Err(error) if inputs.len() == 1 => return Err(error),
                Err(error) => report.failure(Some(input), &error)?,
            }
        }
        if waiting.is_empty() {
            return Err(Error::not_found("none of the inputs can be read; the errors are above"));
        }
        Ok(Some(Self { waiting, given: 0 }))
    }

    /// Returns the number of frames according to the indices of the recordings.
    pub fn len_hint(&self) -> u64 {
        self.waiting.iter().fold(0, |sum, opened| sum.saturating_add(opened.messages))
    }
}

impl Opened {
    fn open(entry: &'static Entry, path: &Path, matches: &ArgMatches) -> Result<Self> {
        let recording = Arc::new(Recording::open(path)?);
        let topics = port_topics(entry, &recording, matches)?;
        let first = topics.first().map(|(_, port)| port.topic.clone()).unwrap_or_default();
        let topic = recording.topics().into_iter().find(|topic| topic.name == first);
        let messages = topic.map_or(0, |topic| topic.messages);
        let (ports, topics): (Vec<_>, Vec<_>) = topics.into_iter().unzip();
        let mut sets = SyncedSets::open(&recording, topics)?;
        let ahead = sets.next();
        let span = recording.bag().start_ns().zip(recording.bag().end_ns());
        let duration_s = span.map(|(start, end)| end.saturating_sub(start) as f64 * 1e-9);
        let rate = duration_s.map_or(RATE, |seconds| (messages.saturating_sub(1)) as f64 / seconds);
        let rate = if rate.is_normal() { rate.clamp(0.1, 240.0) } else { RATE };
        let info = Arc::new(VideoInfo { frame_rate: rate, frames: Some(messages), duration_s });
        Ok(Self {
            recording,
            path: path.into(),
            ports,
            sets,
            ahead,
            info,
            messages,
            number: 0,
            reported: false,
        })
    }

    fn next(&mut self) -> Option<Result<SyncedSet>> {
        let next = self.ahead.take()?;
        self.ahead = self.sets.next();
        Some(next)
    }

    fn item(&self, set: SyncedSet, index: u64) -> Result<Item> {
        let SyncedSet { values, messages, log_time_ns, .. } = set;
        let number = self.number;
        let mut values = self.ports.iter().copied().zip(values);
        let first = values.next().and_then(|(_, value)| value);
        let first = first.ok_or_else(|| Error::internal("a set without a value for the first port"))?;
        let further = values.filter_map(|(port, value)| Some((port, value?))).collect();
        let path = self.path.clone();
        let datum = match first {
            Value::Image(image) => Datum::Frame(Frame {
                image,
                path,
                item_index: index,
                frame_index: number,
                video: Some(self.info.clone()),
            }),
            value => Datum::Value { value: Box::new(value), path, index, number, is_of_stream: true },
        };
        let messages = messages.into_iter().flatten().collect();
        let (recording, is_last) = (self.recording.clone(), self.ahead.is_none());
        let recorded = RecordedSet { further, log_time_ns, is_last, messages, recording };
        Ok(Item { datum, from_files: Vec::new(), recorded: Some(Box::new(recorded)) })
    }

    /// Returns the error to report at the end of the recording, if messages had no match.
    fn unmatched_error(&mut self) -> Option<Error> {
        let unmatched = self.sets.unmatched();
        if unmatched == 0 || std::mem::replace(&mut self.reported, true) {
            return None;
        }
        let first = self.ports.first().copied().unwrap_or_default();
        let further = self.ports.get(1..).unwrap_or_default().join(", ");
        Some(Error::invalid_input(format!(
            "{}: {unmatched} messages for {first} had none for {further} within 20 ms and were skipped",
            self.path.display()
        )))
    }
}

impl Iterator for Recordings {
    type Item = Next;

    fn next(&mut self) -> Option<Next> {
        loop {
            let opened = self.waiting.front_mut()?;
            let path = opened.path.clone();
            let failed = |error: Error| Some(Err((Some(path.to_path_buf()), error)));
            let index = self.given;
            match opened.next() {
                Some(set) => {
                    self.given += 1;
                    let place = || format!("{} frame {}", path.display(), opened.number);
                    let next = match set.and_then(|set| opened.item(set, index)) {
                        Ok(item) => Some(Ok(item)),
                        Err(error) => failed(error.context(place())),
                    };
                    opened.number += 1;
                    return next;
                }
                None => {
                    let unmatched = opened.unmatched_error();
                    self.waiting.pop_front();
                    if let Some(error) = unmatched {
                        return failed(error);
                    }
                }
            }
        }
    }
}
