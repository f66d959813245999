//! `opendr infer`: a learner over pictures, folders, videos, cameras.

use std::iter;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::learner::{AnyLearner, Entry, Outputs, Ports};
use opendr::vision::{Frame, Source, SourceOptions};
use opendr::{Error, Progress, Result, Unit, ValueType, map_in_order};

use crate::exit::Outcome;
use crate::port_file::PortFile;
use crate::progress_bar::{Bar, interrupted};
use crate::report::{Json, Report};
use crate::timings::Timings;
use crate::writer::Writer;
use crate::{learner_flags, loading};

const EXAMPLES: &str = "\
Examples:
  opendr infer LEARNER street.jpg                        print what is found
  opendr infer LEARNER street.jpg --out seen.png         ... and draw it
  opendr infer LEARNER pictures/ --out seen/ --json      one line of JSON a picture
  opendr infer LEARNER 'photos/**/*.jpg' --threshold 0.8
  opendr infer LEARNER/VARIANT dance.mp4 --out dance-seen.mp4
  opendr infer LEARNER camera:0 --limit 100

\"opendr infer LEARNER --help\" lists the learner's parameters; \"opendr models\" lists the learners.";

pub fn grammar() -> Command {
    let switch = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    let path = |name: &'static str| Arg::new(name).long(name).value_parser(value_parser!(PathBuf));
    Command::new("infer")
        .about("Run a learner on pictures, folders, patterns, videos or a camera")
        .arg(loading::learner())
        .arg(
            Arg::new("input")
                .required(true)
                .num_args(1..)
                .value_parser(value_parser!(PathBuf))
                .value_name("INPUT")
                .help("Pictures, folders, quoted patterns, video files, camera:N"),
        )
        .args([
            path("out")
                .short('o')
                .value_name("DIR|FILE")
                .help("Write annotated pictures: into a folder, or to one picture or video file"),
            path("json").num_args(0..=1).require_equals(true).value_name("FILE").help(
                "Print a line of JSON a frame instead of text, or write it to FILE besides (docs/command-line.md)",
            ),
            switch("show-timings").help("Tell how long each stage took"),
            switch("sequence").help("The pictures follow each other in time, as frames of one video do"),
            Arg::new("limit")
                .long("limit")
                .value_parser(value_parser!(u64).range(1..))
                .value_name("N")
                .help("Stop after N frames"),
        ])
        .args(loading::flags())
        .after_help(EXAMPLES)
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let spec = matches.get_one::<String>(loading::LEARNER).map_or("", String::as_str);
    let entry = loading::entry(spec)?;
    let bar = Bar::new(matches.get_flag("quiet"));
    let json = match matches.get_one::<PathBuf>("json") {
        Some(path) => Json::file(path)?,
        None if matches.contains_id("json") => Json::Stdout,
        None => Json::Off,
    };
    let mut report = Report::new(&bar, json, matches.get_flag("show-timings"));
    let inputs: Vec<&PathBuf> = matches.get_many("input").into_iter().flatten().collect();
    let source = open(&inputs, &mut report)?;
    let limit = matches.get_one("limit").copied().unwrap_or(u64::MAX);
    let frames =
        source.len_hint().map_or((limit < u64::MAX).then_some(limit), |count| Some(count.min(limit)));
    let writer = matches.get_one::<PathBuf>("out").map(|out| Writer::new(out, frames)).transpose()?;
    let params = learner_flags::params(entry, matches)?;
    let load = || loading::load(spec, &params, matches, &bar);
    let job = Job {
        entry,
        port: picture_port(entry)?,
        further: learner_flags::port_files(entry, matches)?,
        sequence: matches.get_flag("sequence"),
    };
    let alone = job.sequence || !source.is_pictures();
    let count = if alone { 1 } else { loading::how_many(matches, frames)? };
    let learners = loading::side_by_side(count, load)?;
    let mut workers: Vec<_> = learners.into_iter().map(|learner| Worker { learner, stream: None }).collect();
    if frames != Some(1) {
        bar.begin("frames", frames, Unit::Items);
    }
    let told = job.run(&mut workers, source, limit, &mut report, writer.as_ref(), &bar);
    bar.end();
    // Even when the report cannot go on, what was handed over is finished.
    for (input, error) in writer.map(Writer::finish).unwrap_or_default() {
        report.failure(input.as_deref(), &error)?;
    }
    told?;
    Ok(if report.finish()? == 0 { Outcome::Done } else { Outcome::SomeFailed })
}

/// The port that pictures go into: the first.
fn picture_port(entry: &Entry) -> Result<&'static str> {
    let first = entry.ports.first().filter(|port| port.value_type == ValueType::Image);
    first.map(|port| port.name).ok_or_else(|| {
        let class = entry.spec.class;
        Error::unsupported(format!(
            "{class} takes no pictures; the command line has only those, use Rust or Python"
        ))
    })
}

/// One source over all inputs; those that cannot be opened are reported, and left out.
fn open(inputs: &[&PathBuf], report: &mut Report<'_>) -> Result<Source> {
    let all = Source::open_all(inputs, SourceOptions::default());
    if all.is_ok() || inputs.len() == 1 {
        return all;
    }
    let mut good = Vec::new();
    for input in inputs {
        match Source::open(input) {
            Ok(_) => good.push(*input),
            Err(error) => report.failure(Some(input), &error)?,
        }
    }
    Source::open_all(good, SourceOptions::default())
}

/// What is to be done with each frame.
struct Job {
    entry: &'static Entry,
    port: &'static str,
    further: Vec<PortFile>,
    sequence: bool,
}

/// A learner at work.
struct Worker {
    learner: Box<dyn AnyLearner>,
    /// The video whose frames the learner's stream has seen; for pictures in a sequence, their folder.
    stream: Option<Arc<Path>>,
}

/// A frame with what was found in it, or what failed and for which input.
type Answer = std::result::Result<(Frame, Outputs, Timings), (Option<PathBuf>, Error)>;

impl Job {
    fn run(
        &self,
        workers: &mut [Worker],
        mut source: Source,
        limit: u64,
        report: &mut Report<'_>,
        writer: Option<&Writer>,
        bar: &Bar,
    ) -> Result<()> {
        let mut left = limit;
        let frames = iter::from_fn(|| {
            left = left.checked_sub(1).filter(|_| !interrupted())?;
            let frame = source.next()?;
            Some(frame.map_err(|error| (source.last_path().map(Path::to_owned), error)))
        });
        let answer = |worker: &mut Worker, frame: std::result::Result<Frame, _>| self.answer(worker, frame?);
        map_in_order(workers, frames, answer, |answer| {
            match answer {
                Ok((frame, outputs, timings)) => {
                    report.frame(&frame, &outputs, timings)?;
                    if let Some(writer) = writer {
                        writer.put(frame, outputs)?;
                    }
                }
                Err((input, error)) => report.failure(input.as_deref(), &error)?,
            }
            bar.advance(1);
            Ok(())
        })
    }

    fn answer(&self, worker: &mut Worker, frame: Frame) -> Answer {
        let begins = self.follow(worker, &frame);
        match self.infer(worker, &frame, begins) {
            Ok((outputs, timings)) => Ok((frame, outputs, timings)),
            Err(error) => {
                let error = error.context(frame.path.display().to_string());
                Err((Some(frame.path.to_path_buf()), error))
            }
        }
    }

    fn infer(&self, worker: &mut Worker, frame: &Frame, begins: bool) -> Result<(Outputs, Timings)> {
        let mut ports = Ports::default().with(self.port, &frame.image);
        for file in &self.further {
            let is_init = self.entry.ports.iter().any(|port| port.name == file.name() && port.init);
            if begins || !is_init {
                ports = ports.with(file.name(), file.value(frame.index)?);
            }
        }
        Timings::of(|| worker.learner.infer(&ports))
    }

    /// Every video is a stream of its own, and so is every picture unless they are a sequence. Whether one begins.
    fn follow(&self, worker: &mut Worker, frame: &Frame) -> bool {
        let stream = match (&frame.video, self.sequence) {
            (Some(_), _) => Some(frame.path.clone()),
            (None, true) => frame.path.parent().map(Arc::from),
            (None, false) => None,
        };
        let begins = stream.is_none() || stream != worker.stream;
        if begins {
            worker.learner.reset();
            worker.stream = stream;
        }
        begins
    }
}
