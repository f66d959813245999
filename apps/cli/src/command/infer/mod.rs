//! `opendr infer`: runs a learner on images, folders, videos, cameras, files of other input types, and recordings.

mod chain;
mod job;
mod on_rig;

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::learner::{AnyLearner, Outputs};
use opendr::target::Classes;
use opendr::{Error, ErrorKind, Pipeline, Progress, Result, Unit, ValueType, map_in_order};

use crate::dump::Dump;
use crate::exit::Outcome;
use crate::inputs::Inputs;
use crate::item::{Datum, Item, Next};
use crate::progress_bar::{ProgressBar, interrupted};
use crate::recordings::RecordingSink;
use crate::report::{Json, Report};
use crate::timings::Timings;
use crate::viewing::Pace;
use crate::writer::{Failures, Writer};
use crate::{learner_flags, loading, recordings, then_flag, viewing};
use job::{InferenceResult, Job, Stream, of_item};

const EXAMPLES: &str = "\
Examples:
  opendr infer LEARNER street.jpg                        print the predictions
  opendr infer LEARNER street.jpg --out boxes.png        ... and draw them
  opendr infer LEARNER images/ --out drawn/ --json       one line of JSON per image
  opendr infer LEARNER 'photos/**/*.jpg' --threshold 0.8
  opendr infer LEARNER/VARIANT dance.mp4 --out dance-poses.mp4
  opendr infer LEARNER camera:0 --limit 100
  opendr infer yolo.onnx street.jpg                      a detector of another tool
  opendr infer matchboxnet yes.wav no.wav                audio, time series (.csv), point clouds
  opendr infer LEARNER drive.bag --topic /camera/image_raw --out boxes.mcap
  opendr infer nanodet walk.mp4 --then 'posenet threshold=0.3' --out poses.mp4  a pipeline, in parallel
  opendr infer yunet crowd.mp4 --then 'each facial_emotion input_kind=face'          ... one call per detected box
  opendr infer active_face_recognition --model MODEL --rig SphereView-Face-v1        move a camera until the class is certain
  opendr infer LEARNER wrong.jpg --dump tensors/         debug a wrong prediction: all tensors as .npy

\"opendr infer LEARNER --help\" lists the learner's parameters; \"opendr models\" lists the learners.";

pub fn grammar() -> Command {
    arguments(Command::new("infer"))
        .about("Run a learner on images, videos, a camera, files of other input types, or recordings")
        .mut_arg("input", |input| input.required_unless_present(on_rig::RIG))
        .after_help(EXAMPLES)
}

/// Adds the arguments of `infer`, which are those of `view` too.
pub fn arguments(command: Command) -> Command {
    let switch = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    let path = |name: &'static str| Arg::new(name).long(name).value_parser(value_parser!(PathBuf));
    let command = command
        .arg(loading::learner())
        .arg(
            Arg::new("input")
                .num_args(1..)
                .value_parser(value_parser!(PathBuf))
                .value_name("INPUT")
                .help("Images, folders, quoted patterns, video files, camera:N; files of the learner's input type; or recordings (.bag, .mcap, rosbag 2 folders)"),
        )
        .args([
            path("out")
                .short('o')
                .value_name("DIR|FILE")
                .help("Write annotated images into a folder, an image file or a video file; or record the predictions (.bag, .mcap)"),
            path("json").num_args(0..=1).require_equals(true).value_name("FILE").help(
                "Print one line of JSON per frame instead of text, or write the lines to FILE besides the text (docs/command-line.md)",
            ),
            switch("show-timings").help("Print the duration of each stage"),
            path("dump").value_name("DIR").help(
                "Write the tensors before and after each stage as .npy into a new folder, with an index dump.json (about 10 MB per image)",
            ),
            switch("sequence").help("Treat the images as frames of one video"),
            then_flag::flag(),
            Arg::new("limit")
                .long("limit")
                .value_parser(value_parser!(u64).range(1..))
                .value_name("N")
                .help("Stop after N frames"),
        ])
        .args([viewing::flag(), viewing::write_flag()])
        .args(recordings::flags())
        .args(loading::flags());
    on_rig::add(command)
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    run_with(matches, None)
}

/// Displays items at the speed of their streams, and the last one until Ctrl-C.
pub fn run_until_interrupt(matches: &ArgMatches) -> Result<Outcome> {
    run_with(matches, Some(Hold::default()))
}

fn run_with(matches: &ArgMatches, mut hold: Option<Hold>) -> Result<Outcome> {
    let spec = matches.get_one::<String>(loading::LEARNER).map_or("", String::as_str);
    let entry = loading::entry(spec)?;
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    if let Some(rig) = matches.get_one::<String>(on_rig::RIG) {
        return on_rig::run(spec, entry, rig, matches, &bar);
    }
    let json = match matches.get_one::<PathBuf>("json") {
        Some(path) => Json::file(path)?,
        None if matches.contains_id("json") => Json::Stdout,
        None => Json::Off,
    };
    let mut report = Report::new(&bar, json, matches.get_flag("show-timings"));
    let inputs: Vec<&PathBuf> = matches.get_many("input").into_iter().flatten().collect();
    let port = entry.ports.first().ok_or_else(|| Error::internal("the learner has no input port"))?;
    let out = matches.get_one::<PathBuf>("out");
    let sink = RecordingSink::new(entry, matches, &inputs)?;
    if then_flag::is_given(matches) {
        chain::check(matches, sink.is_some())?;
    }
    if out.is_some() && sink.is_none() && port.value_type != ValueType::Image {
        let (class, given) = (entry.spec.class, port.value_type.name());
        return Err(Error::invalid_param(format!(
            "--out draws on images, but the input of {class} is {given}; record the predictions (--out predictions.mcap), or write them with --json=FILE"
        )));
    }
    let items = Inputs::open(entry, &inputs, matches, &mut report)?;
    let limit = matches.get_one("limit").copied().unwrap_or(u64::MAX);
    let frames = items.len_hint().map_or((limit < u64::MAX).then_some(limit), |count| Some(count.min(limit)));
    let mut out = match (sink, out) {
        (Some(sink), _) => Out::Recorded(Box::new(sink)),
        (None, Some(out)) => Out::Drawn(Writer::new(out, frames)?),
        (None, None) => Out::Nowhere,
    };
    let params = learner_flags::params(entry, matches)?;
    let load = || loading::load(spec, &params, matches, &bar);
    let chained = then_flag::is_given(matches);
    let mut job = Job {
        entry,
        port: port.name,
        further: learner_flags::port_files(entry, matches)?,
        sequence: matches.get_flag("sequence"),
        limit,
        viewer: None,
    };
    let dump = matches.get_one::<PathBuf>("dump").map(|folder| Dump::create(folder)).transpose()?;
    let alone = chained || job.sequence || dump.is_some() || !items.are_independent();
    let count = if alone { 1 } else { loading::copies(matches, frames)? };
    let mut learners = loading::load_copies(count, load)?;
    let adjustable = learners.first().filter(|_| !chained).map(AsRef::as_ref);
    job.viewer = viewing::of_learner(entry, adjustable, matches, &bar)?;
    let mut processors = match learners.pop() {
        Some(first) if chained => {
            Learners::Chain(then_flag::pipeline(entry, first.as_ref(), matches, &bar)?, Stream::default())
        }
        first => {
            let learners = learners.into_iter().chain(first);
            Learners::Parallel(
                learners
                    .zip(std::iter::once(dump).chain(std::iter::repeat_with(|| None)))
                    .map(|(learner, dump)| Worker {
                        learner,
                        stream: Stream::default(),
                        dump,
                        last_change: 0,
                    })
                    .collect(),
            )
        }
    };
    if let Out::Recorded(sink) = &mut out {
        sink.begin()?;
    }
    if frames != Some(1) {
        bar.begin("frames", frames, Unit::Items);
    }
    let result = job.run(&mut processors, items, &mut report, &mut out, &bar, hold.as_mut());
    bar.end();
    // Frames that were handed to the writer are finished even after an error.
    for (input, error) in out.finish() {
        report.failure(input.as_deref(), &error)?;
    }
    result?;
    if let Some(hold) = hold.filter(|_| !interrupted()) {
        bar.note("the page displays the last item; Ctrl-C ends it");
        job.hold(&mut processors, hold.last.as_ref());
    }
    Ok(if report.finish()? == 0 { Outcome::Done } else { Outcome::SomeFailed })
}

/// State of `opendr view`.
#[derive(Default)]
struct Hold {
    pace: Pace,
    /// The item on the page, unless it was passed on to an output.
    last: Option<Item>,
}

/// A learner with its stream.
struct Worker {
    learner: Box<dyn AnyLearner>,
    stream: Stream,
    dump: Option<Dump>,
    /// Number of the last change of a parameter by the viewer.
    last_change: u64,
}

/// Learners that process the items.
enum Learners {
    /// Copies of one learner, each of which processes a part of the items.
    Parallel(Vec<Worker>),
    /// Learners in sequence, each of which processes all items.
    Chain(Pipeline, Stream),
}

/// Destination of predictions besides the report.
enum Out {
    Nowhere,
    Drawn(Writer),
    Recorded(Box<RecordingSink>),
}

impl Out {
    /// Passes the predictions of an item on.
    fn put(&mut self, item: Item, outputs: Vec<Outputs>, classes: &Classes) -> Result<()> {
        match self {
            Self::Nowhere => Ok(()),
            Self::Drawn(writer) => match item.datum {
                Datum::Frame(frame) => {
                    outputs.into_iter().next().map_or(Ok(()), |outputs| writer.put(frame, outputs))
                }
                Datum::Value { .. } => Ok(()),
            },
            Self::Recorded(sink) => sink.put(&item, &outputs, classes),
        }
    }

    fn finish(self) -> Failures {
        match self {
            Self::Nowhere => Failures::new(),
            Self::Drawn(writer) => writer.finish(),
            Self::Recorded(sink) => sink.finish().err().map(|error| (None, error)).into_iter().collect(),
        }
    }
}

impl Learners {
    fn classes(&self) -> Classes {
        match self {
            Self::Parallel(workers) => {
                workers.first().map(|worker| worker.learner.classes()).unwrap_or_default()
            }
            Self::Chain(..) => Classes::default(),
        }
    }
}

impl Job {
    fn run(
        &self,
        learners: &mut Learners,
        mut inputs: Inputs,
        report: &mut Report<'_>,
        out: &mut Out,
        bar: &ProgressBar,
        mut hold: Option<&mut Hold>,
    ) -> Result<()> {
        let classes = learners.classes();
        let mut left = self.limit;
        let items = std::iter::from_fn(|| {
            left = left.checked_sub(1).filter(|_| !interrupted())?;
            Some(inputs.next()?.and_then(|item| self.with_files(item)))
        });
        let report_result = |result: InferenceResult| {
            match result {
                Ok((item, outputs, timings)) => {
                    for outputs in &outputs {
                        report.item(&item, outputs, timings)?;
                    }
                    if let Some(viewer) = &self.viewer {
                        if let Some(hold) = &mut hold {
                            hold.pace.wait(&item);
                        }
                        viewing::show(viewer, &item, &outputs, timings);
                    }
                    let path = item.path().clone();
                    let done = match (&mut hold, &mut *out) {
                        (Some(hold), Out::Nowhere) => {
                            hold.last = Some(item);
                            Ok(())
                        }
                        (_, out) => out.put(item, outputs, &classes),
                    };
                    match done {
                        // Another item may still be writable.
                        Err(error) if error.kind() == ErrorKind::InvalidInput => {
                            report.failure(Some(&path), &error)?;
                        }
                        done => done?,
                    }
                }
                Err((input, error)) => report.failure(input.as_deref(), &error)?,
            }
            bar.advance(1);
            Ok(())
        };
        match learners {
            Learners::Parallel(workers) => {
                map_in_order(workers, items, |worker, item: Next| self.process(worker, item?), report_result)
            }
            Learners::Chain(pipeline, stream) => chain::run(self, pipeline, stream, items, report_result),
        }
    }

    fn process(&self, worker: &mut Worker, item: Item) -> InferenceResult {
        let begins = self.follow(&mut worker.stream, &item);
        if begins {
            worker.learner.reset();
        }
        self.apply_changes(worker);
        match self.infer_and_dump(worker, &item, begins) {
            Ok((outputs, timings)) => Ok((item, outputs, timings)),
            Err(error) => Err(of_item(&item, error)),
        }
    }

    /// Applies the parameters that pages changed. Returns whether there are any.
    fn apply_changes(&self, worker: &mut Worker) -> bool {
        let Some(viewer) = &self.viewer else { return false };
        let changes = viewer.changes(&mut worker.last_change);
        let is_changed = !changes.is_empty();
        for (name, value) in changes {
            worker.learner.set(&name, value).unwrap_or_else(|error| viewer.fail(&error));
        }
        is_changed
    }

    /// Waits until Ctrl-C. A parameter that changes is applied to the last item, unless it belongs to a stream.
    fn hold(&self, learners: &mut Learners, last: Option<&Item>) {
        let worker = match learners {
            Learners::Parallel(workers) => workers.first_mut(),
            Learners::Chain(..) => None,
        };
        let last = last.filter(|item| !item.is_of_stream());
        let (Some(viewer), Some(item), Some(worker)) = (&self.viewer, last, worker) else {
            return viewing::wait_for_interrupt();
        };
        while !interrupted() {
            viewing::sleep(viewing::POLL);
            if self.apply_changes(worker) {
                worker.learner.reset();
                match self.infer(worker, item, true) {
                    Ok((outputs, timings)) => viewing::show(viewer, item, &outputs, timings),
                    Err(error) => viewer.fail(&error),
                }
            }
        }
    }

    /// Infers an item and writes its tensors if requested, after an error too.
    fn infer_and_dump(
        &self,
        worker: &mut Worker,
        item: &Item,
        begins: bool,
    ) -> Result<(Vec<Outputs>, Timings)> {
        let Some(mut dump) = worker.dump.take() else { return self.infer(worker, item, begins) };
        let (result, runs) = Dump::record(|| self.infer(worker, item, begins));
        let written = dump.write(item, &runs, result.as_ref().ok().map(|(outputs, _)| &outputs[..]));
        worker.dump = Some(dump);
        result.and_then(|result| written.map(|()| result))
    }

    fn infer(&self, worker: &mut Worker, item: &Item, begins: bool) -> Result<(Vec<Outputs>, Timings)> {
        let ports = self.ports(item, begins)?;
        let is_chunk = self.entry.capabilities.streaming && item.recorded.is_some();
        Timings::of(|| {
            if !is_chunk {
                return worker.learner.infer(&ports).map(|outputs| vec![outputs]);
            }
            let mut outputs = Vec::new();
            worker.learner.push(Some(&ports), &mut |found| outputs.push(found))?;
            if item.recorded.as_ref().is_some_and(|recorded| recorded.is_last) {
                worker.learner.push(None, &mut |found| outputs.push(found))?;
            }
            Ok(outputs)
        })
    }
}
