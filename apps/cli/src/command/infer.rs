//! `opendr infer`: a learner over pictures, folders, videos, cameras.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::learner::{AnyLearner, Outputs, Ports};
use opendr::vision::{Frame, Source, SourceOptions};
use opendr::{Error, Progress, Result, Unit, Value};

use crate::exit::Outcome;
use crate::progress_bar::{Bar, interrupted};
use crate::record::{self, Failure, Record};
use crate::timings::Timings;
use crate::writer::Writer;
use crate::{learner_flags, loading};

const EXAMPLES: &str = "\
Examples:
  opendr infer centernet street.jpg                        print what is found
  opendr infer centernet street.jpg --out seen.png         ... and draw it
  opendr infer nanodet pictures/ --out seen/ --json        one JSON line a picture
  opendr infer yunet 'photos/*.jpg' --threshold 0.8
  opendr infer movenet/multipose dance.mp4 --out dance-poses.mp4
  opendr infer ultra_light_face camera:0 --limit 100

`opendr infer LEARNER --help` lists the learner's parameters; `opendr models` lists the learners.";

pub fn grammar() -> Command {
    Command::new("infer")
        .about("Run a learner on pictures, folders, globs, videos or a camera")
        .arg(Arg::new("learner").required(true).value_name("LEARNER[/VARIANT]").help("What to run"))
        .arg(
            Arg::new("input")
                .required(true)
                .num_args(1..)
                .value_parser(value_parser!(PathBuf))
                .value_name("INPUT")
                .help("Pictures, folders, quoted globs, video files, camera:N"),
        )
        .arg(
            Arg::new("out")
                .long("out")
                .short('o')
                .value_parser(value_parser!(PathBuf))
                .value_name("DIR|FILE")
                .help("Write annotated pictures here: a folder, or a file for one picture or video"),
        )
        .arg(
            Arg::new("json")
                .long("json")
                .action(ArgAction::SetTrue)
                .help("Print one JSON line a frame (docs/json.md)"),
        )
        .arg(
            Arg::new("timings")
                .long("show-timings")
                .action(ArgAction::SetTrue)
                .help("Print how long each stage took"),
        )
        .arg(
            Arg::new("limit")
                .long("limit")
                .value_parser(value_parser!(usize))
                .value_name("N")
                .help("Stop after N frames of each input"),
        )
        .args(loading::flags())
        .after_help(EXAMPLES)
}

struct Run<'a> {
    learner: Box<dyn AnyLearner>,
    first_port: &'static str,
    ports: Vec<(&'static str, Value)>,
    bar: &'a Bar,
    json: bool,
    timings: bool,
    failed: bool,
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    loading::set_threads(matches);
    let spec = matches.get_one::<String>("learner").map_or("", String::as_str);
    let entry = loading::entry(spec)?;
    let bar = Bar::new(matches.get_flag("quiet"));
    let mut run = Run {
        learner: loading::load(spec, entry, matches, &bar)?,
        first_port: entry.ports.first().map_or("", |port| port.name),
        ports: learner_flags::ports(entry, matches)?,
        bar: &bar,
        json: matches.get_flag("json"),
        timings: matches.get_flag("timings"),
        failed: false,
    };
    let inputs: Vec<&PathBuf> = matches.get_many("input").into_iter().flatten().collect();
    let source = run.open(&inputs)?;
    let mut writer = matches.get_one::<PathBuf>("out").map(|out| Writer::new(out, &source)).transpose()?;
    run.frames(source, matches.get_one("limit").copied().unwrap_or(usize::MAX), writer.as_mut())?;
    if let Some(writer) = writer {
        for (name, error) in writer.finish() {
            run.failure(&name, &error)?;
        }
    }
    Ok(if run.failed { Outcome::SomeFailed } else { Outcome::Done })
}

impl Run<'_> {
    /// One source over all inputs; those that cannot be opened are reported, and left out.
    fn open(&mut self, inputs: &[&PathBuf]) -> Result<Source> {
        let all = Source::open_all(inputs, SourceOptions::default());
        let Err(error) = all else { return all };
        if inputs.len() == 1 {
            return Err(error);
        }
        let mut good = Vec::new();
        for input in inputs {
            match Source::open(input) {
                Ok(_) => good.push(*input),
                Err(error) => self.failure(&input.display().to_string(), &error)?,
            }
        }
        Source::open_all(good, SourceOptions::default())
    }

    fn frames(&mut self, source: Source, limit: usize, mut writer: Option<&mut Writer>) -> Result<()> {
        let total = source.len_hint().map(|count| count.min(limit as u64));
        if total != Some(1) {
            self.bar.begin("frames", total, Unit::Items);
        }
        let mut video = None;
        for frame in source.take(limit) {
            match frame.and_then(|frame| self.answer(frame, &mut video)) {
                Ok((frame, outputs, timings)) => {
                    self.print(&frame, &outputs, timings)?;
                    if let Some(writer) = &mut writer {
                        writer.put(frame, outputs)?;
                    }
                }
                Err(error) => self.failure("", &error)?,
            }
            self.bar.advance(1);
            if interrupted() {
                break;
            }
        }
        self.bar.end();
        Ok(())
    }

    /// Every video is a stream of its own, and so is every picture.
    fn answer(&mut self, frame: Frame, video: &mut Option<Arc<Path>>) -> Result<(Frame, Outputs, Timings)> {
        let path = frame.video.is_some().then(|| frame.path.clone());
        if path.is_none() || *video != path {
            self.learner.reset();
            *video = path;
        }
        let (outputs, timings) = self.infer(&frame)?;
        Ok((frame, outputs, timings))
    }

    fn infer(&mut self, frame: &Frame) -> Result<(Outputs, Timings)> {
        let ports = Ports::default().with(self.first_port, &frame.image);
        let ports = self.ports.iter().fold(ports, |ports, (name, value)| ports.with(name, value));
        Timings::of(|| self.learner.infer(&ports))
    }

    fn print(&self, frame: &Frame, outputs: &Outputs, timings: Timings) -> Result<()> {
        let timings = self.timings.then_some(timings);
        let input = &frame.path.display().to_string();
        if !self.json {
            return self.line(&record::text(input, outputs, timings));
        }
        let outputs = Some(record::by_name(outputs));
        self.json_line(&Record { input, index: frame.number, outputs, error: None, timings_ms: timings })
    }

    fn failure(&mut self, input: &str, error: &Error) -> Result<()> {
        self.failed = true;
        self.bar.suspend(|| eprintln!("error: {error}"));
        if !self.json {
            return Ok(());
        }
        let error = Some(Failure::from(error));
        self.json_line(&Record { input, index: 0, outputs: None, error, timings_ms: None })
    }

    fn json_line(&self, record: &Record<'_>) -> Result<()> {
        let text = serde_json::to_string(record)
            .map_err(|error| Error::internal("the answer has no JSON form").with_source(error))?;
        self.line(&text)
    }

    fn line(&self, text: &str) -> Result<()> {
        let written = self.bar.suspend(|| writeln!(std::io::stdout(), "{text}"));
        written.map_err(|error| Error::io("writing to standard output").with_source(error))
    }
}
