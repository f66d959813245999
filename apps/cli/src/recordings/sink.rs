//! Recording of predictions, as messages on the topics that a node publishes.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::ArgMatches;
use opendr::bags::{BagFormat, RecordingWriter, WriteOptions, is_recording};
use opendr::learner::{Entry, Outputs};
use opendr::ros::default_topics;
use opendr::target::Classes;
use opendr::{Error, Result, ResultExt, Value};

use crate::item::Item;

/// Time between two images without stamps, and after each file, in nanoseconds (25 Hz).
const STEP_NS: i64 = 40_000_000;

/// A recording of predictions.
pub struct RecordingSink {
    entry: &'static Entry,
    out: PathBuf,
    options: WriteOptions,
    /// The open file, after [`Self::begin`].
    answers: Option<RecordingWriter>,
    with_input: bool,
    classes_written: bool,
    clock: FileClock,
}

impl RecordingSink {
    /// Returns the recording that `--out` and `--bag-format` name; `None` if they name none.
    ///
    /// # Errors
    /// `InvalidParam` when the recording would replace an input, or flags conflict.
    pub fn new(entry: &'static Entry, matches: &ArgMatches, inputs: &[&PathBuf]) -> Result<Option<Self>> {
        let Some(out) = matches.get_one::<PathBuf>("out") else { return Ok(None) };
        let named = matches.get_one::<String>("bag-format").map(|name| name.parse::<BagFormat>());
        let Some(format) = named.transpose()?.or_else(|| RecordingWriter::format_of(out)) else {
            if matches.get_flag("with-input") || matches.get_flag("overwrite") {
                return Err(Error::invalid_param(format!(
                    "{} has no recording format: name it .bag or .mcap, or choose a --bag-format",
                    out.display()
                )));
            }
            if is_recording(out) {
                return Err(Error::invalid_param(format!(
                    "{} is a file of a rosbag 2 recording: name its folder, and choose --bag-format bag2_sqlite or bag2_mcap",
                    out.display()
                )));
            }
            return Ok(None);
        };
        let same = |input: &Path| {
            out.canonicalize().is_ok_and(|out| input.canonicalize().is_ok_and(|input| input == out))
        };
        if inputs.iter().any(|input| same(input)) {
            let out = out.display();
            return Err(Error::invalid_param(format!("{out} is the input itself; write to another file")));
        }
        if out.exists() && !matches.get_flag("overwrite") {
            let out = out.display();
            return Err(Error::invalid_param(format!(
                "{out} already exists; choose another name, or replace it with --overwrite"
            )));
        }
        let options = WriteOptions { overwrite: matches.get_flag("overwrite"), ..WriteOptions::new(format) };
        Ok(Some(Self {
            entry,
            out: out.clone(),
            options,
            answers: None,
            with_input: matches.get_flag("with-input"),
            classes_written: false,
            clock: FileClock::default(),
        }))
    }

    /// Creates the file. Nothing is written before, so that a command that fails earlier leaves no file.
    ///
    /// # Errors
    /// As [`RecordingWriter::create`].
    pub fn begin(&mut self) -> Result<()> {
        self.answers = Some(RecordingWriter::create(&self.out, self.options)?);
        Ok(())
    }

    /// Records the predictions of an item, at the log time of its message or, for files, at its stamp.
    ///
    /// # Errors
    /// `Io` when the disk is full; `InvalidInput` for a value that has no message, after which others can be written.
    pub fn put(&mut self, item: &Item, outputs: &[Outputs], classes: &Classes) -> Result<()> {
        let time_ns = match &item.recorded {
            Some(recorded) => recorded.log_time_ns,
            None => self.clock.time_ns(item),
        };
        self.record(item, outputs, classes, time_ns).context(|| format!("writing {}", self.out.display()))
    }

    fn record(&mut self, item: &Item, outputs: &[Outputs], classes: &Classes, time_ns: i64) -> Result<()> {
        let name = self.entry.spec.name;
        let Some(answers) = &mut self.answers else {
            return Err(Error::internal("a recording was written before it was created"));
        };
        if !std::mem::replace(&mut self.classes_written, true) {
            answers.write_classes(&format!("/{name}/label_info"), classes, time_ns)?;
        }
        if self.with_input {
            record_input(self.entry, answers, item, time_ns)?;
        }
        for (output, value) in outputs.iter().flat_map(Outputs::iter) {
            let mut value = value.clone();
            let header = value.header_mut();
            // Predictions without a stamp get the time of their input, by which they can be matched.
            header.stamp_ns = header.stamp_ns.or(Some(time_ns));
            let header = header.clone();
            answers.write(&format!("/{name}/{output}"), value.as_value_ref(), time_ns)?;
            let action = format!("/{name}/set_view_action");
            answers.write_action(&action, value.as_value_ref(), &header, time_ns)?;
        }
        Ok(())
    }

    /// Writes the rest and the index.
    ///
    /// # Errors
    /// `Io` when the disk is full.
    pub fn finish(self) -> Result<()> {
        let finished = self.answers.map_or(Ok(()), RecordingWriter::finish);
        finished.context(|| format!("writing {}", self.out.display()))
    }
}

fn record_input(
    entry: &'static Entry,
    answers: &mut RecordingWriter,
    item: &Item,
    time_ns: i64,
) -> Result<()> {
    if let Some(recorded) = &item.recorded {
        return recorded.messages.iter().try_for_each(|message| answers.copy(&recorded.recording, message));
    }
    let defaults = default_topics(entry);
    let Some(topic) = defaults.inputs.first() else { return Ok(()) };
    let mut value = item.value().to_value();
    let header = value.header_mut();
    header.stamp_ns = header.stamp_ns.or(Some(time_ns));
    let name = format!("/{}", topic.topic);
    if let Value::Image(_) = &value {
        // Compressed, so that the message is about as small as the image file.
        let message = "sensor_msgs/msg/CompressedImage".parse()?;
        return answers.write_as(&format!("{name}/compressed"), value.as_value_ref(), message, time_ns);
    }
    answers.write(&name, value.as_value_ref(), time_ns)
}

/// Log times of items from files: stamps of a video, fixed steps for images; files follow each other.
#[derive(Default)]
struct FileClock {
    path: Option<Arc<Path>>,
    base_ns: i64,
    last_ns: Option<i64>,
}

impl FileClock {
    fn time_ns(&mut self, item: &Item) -> i64 {
        let next = self.last_ns.map_or(0, |last| last.saturating_add(STEP_NS));
        let stamp = item.stamp_ns();
        if self.path.as_ref() != Some(item.path()) {
            self.path = Some(item.path().clone());
            self.base_ns = 0;
        }
        let mut time = stamp.map_or(next, |stamp| stamp.saturating_add(self.base_ns));
        // The stamps of each video begin at 0.
        if self.last_ns.is_some_and(|last| time <= last) {
            self.base_ns = next.saturating_sub(stamp.unwrap_or(0));
            time = next;
        }
        self.last_ns = Some(time);
        // rosbag 1 does not allow time 0.
        time.max(1)
    }
}
