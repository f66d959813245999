//! `opendr infer`: a learner over pictures, folders, videos, cameras, and files of what else learners take.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::learner::{AnyLearner, Entry, Outputs, Ports};
use opendr::{Error, Progress, Result, Unit, ValueType, map_in_order};

use crate::exit::Outcome;
use crate::inputs::{Inputs, Item};
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
  opendr infer matchboxnet yes.wav no.wav                sounds, series (.csv), point clouds

\"opendr infer LEARNER --help\" lists the learner's parameters; \"opendr models\" lists the learners.";

pub fn grammar() -> Command {
    let switch = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    let path = |name: &'static str| Arg::new(name).long(name).value_parser(value_parser!(PathBuf));
    Command::new("infer")
        .about("Run a learner on pictures, videos, a camera, or files of what else it takes")
        .arg(loading::learner())
        .arg(
            Arg::new("input")
                .required(true)
                .num_args(1..)
                .value_parser(value_parser!(PathBuf))
                .value_name("INPUT")
                .help("Pictures, folders, quoted patterns, video files, camera:N; or files of the type that the learner takes"),
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
    let port = entry.ports.first().ok_or_else(|| Error::internal("the learner takes nothing"))?;
    let out = matches.get_one::<PathBuf>("out");
    if out.is_some() && port.value_type != ValueType::Image {
        let (class, given) = (entry.spec.class, port.value_type.name());
        return Err(Error::invalid_param(format!(
            "--out draws on pictures, and {class} takes {given}; leave it away, or write answers by --json=FILE"
        )));
    }
    let items = Inputs::open(port.value_type, &inputs, &mut report)?;
    let limit = matches.get_one("limit").copied().unwrap_or(u64::MAX);
    let frames = items.len_hint().map_or((limit < u64::MAX).then_some(limit), |count| Some(count.min(limit)));
    let writer = out.map(|out| Writer::new(out, frames)).transpose()?;
    let params = learner_flags::params(entry, matches)?;
    let load = || loading::load(spec, &params, matches, &bar);
    let job = Job {
        entry,
        port: port.name,
        further: learner_flags::port_files(entry, matches)?,
        sequence: matches.get_flag("sequence"),
    };
    let alone = job.sequence || !items.are_separate();
    let count = if alone { 1 } else { loading::how_many(matches, frames)? };
    let learners = loading::side_by_side(count, load)?;
    let mut workers: Vec<_> = learners.into_iter().map(|learner| Worker { learner, stream: None }).collect();
    if frames != Some(1) {
        bar.begin("frames", frames, Unit::Items);
    }
    let told = job.run(&mut workers, items, limit, &mut report, writer.as_ref(), &bar);
    bar.end();
    // Even when the report cannot go on, what was handed over is finished.
    for (input, error) in writer.map(Writer::finish).unwrap_or_default() {
        report.failure(input.as_deref(), &error)?;
    }
    told?;
    Ok(if report.finish()? == 0 { Outcome::Done } else { Outcome::SomeFailed })
}

/// What is to be done with each item.
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

/// An item with what was found in it, or what failed and for which input.
type Answer = std::result::Result<(Item, Outputs, Timings), (Option<PathBuf>, Error)>;

impl Job {
    fn run(
        &self,
        workers: &mut [Worker],
        mut inputs: Inputs,
        limit: u64,
        report: &mut Report<'_>,
        writer: Option<&Writer>,
        bar: &Bar,
    ) -> Result<()> {
        let mut left = limit;
        let items = std::iter::from_fn(|| {
            left = left.checked_sub(1).filter(|_| !interrupted())?;
            inputs.next()
        });
        let answer = |worker: &mut Worker, item: std::result::Result<Item, _>| self.answer(worker, item?);
        map_in_order(workers, items, answer, |answer| {
            match answer {
                Ok((item, outputs, timings)) => {
                    report.item(&item, &outputs, timings)?;
                    if let (Some(writer), Item::Frame(frame)) = (writer, item) {
                        writer.put(frame, outputs)?;
                    }
                }
                Err((input, error)) => report.failure(input.as_deref(), &error)?,
            }
            bar.advance(1);
            Ok(())
        })
    }

    fn answer(&self, worker: &mut Worker, item: Item) -> Answer {
        let begins = self.follow(worker, &item);
        match self.infer(worker, &item, begins) {
            Ok((outputs, timings)) => Ok((item, outputs, timings)),
            Err(error) => {
                let path = item.path();
                Err((Some(path.to_path_buf()), error.context(path.display().to_string())))
            }
        }
    }

    fn infer(&self, worker: &mut Worker, item: &Item, begins: bool) -> Result<(Outputs, Timings)> {
        let mut ports = Ports::default().with(self.port, item.value());
        for file in &self.further {
            let is_init = self.entry.ports.iter().any(|port| port.name == file.name() && port.init);
            if begins || !is_init {
                ports = ports.with(file.name(), file.value(item.index())?);
            }
        }
        Timings::of(|| worker.learner.infer(&ports))
    }

    /// Every video is a stream of its own, and so is every other file unless they are a sequence. Whether one begins.
    fn follow(&self, worker: &mut Worker, item: &Item) -> bool {
        let stream = match (item.is_of_video(), self.sequence) {
            (true, _) => Some(item.path().clone()),
            (false, true) => item.path().parent().map(Arc::from),
            (false, false) => None,
        };
        let begins = stream.is_none() || stream != worker.stream;
        if begins {
            worker.learner.reset();
            worker.stream = stream;
        }
        begins
    }
}
