//! `--view`: a local web page beside a command.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::path::Path;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use opendr::learner::{AnyLearner, Entry, Outputs};
use opendr::viewer::{CurveSource, Shown, Viewer, ViewerOptions};
use opendr::{Error, Result, ValueRef};

use crate::item::{Datum, Item};
use crate::progress_bar::{ProgressBar, interrupted};
use crate::timings::Timings;

const VIEW: &str = "view";
const VIEW_WRITE: &str = "view-write";
/// Address of the page unless another one is given.
pub const ADDRESS: &str = "127.0.0.1:7007";
/// Time for which `opendr view` displays an item that is no frame of a stream.
const STILL: Duration = Duration::from_secs(1);
/// Time between two checks for Ctrl-C.
pub const POLL: Duration = Duration::from_millis(50);

/// Returns the flag of the page.
pub fn flag() -> Arg {
    Arg::new(VIEW)
        .long(VIEW)
        .value_parser(value_parser!(SocketAddr))
        .num_args(0..=1)
        .require_equals(true)
        .default_missing_value(ADDRESS)
        .value_name("ADDRESS:PORT")
        .help(format!("Serve a web page of inputs, predictions and latencies, or of a training's curves [default: {ADDRESS}]"))
}

/// Returns the flag that lets the page change live parameters.
pub fn write_flag() -> Arg {
    Arg::new(VIEW_WRITE)
        .long(VIEW_WRITE)
        .action(ArgAction::SetTrue)
        .help("Let the page of --view change the learner's live parameters")
}

/// Starts the page of a learner; parameters are those of `learner`, if there is one.
///
/// # Errors
/// `Io` when the port is in use.
pub fn of_learner(
    entry: &Entry,
    learner: Option<&dyn AnyLearner>,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<Option<Viewer>> {
    let options = ViewerOptions {
        title: entry.spec.class.to_owned(),
        params: learner.map_or(&[], |_| entry.params),
        values: learner.map_or_else(BTreeMap::new, AnyLearner::params),
        is_writable: matches.get_flag(VIEW_WRITE),
        curves: None,
    };
    start(options, matches, bar)
}

/// Starts the page of items alone, without parameters.
///
/// # Errors
/// `Io` when the port is in use.
pub fn of_items(title: &str, matches: &ArgMatches, bar: &ProgressBar) -> Result<Option<Viewer>> {
    start(ViewerOptions { title: title.to_owned(), ..ViewerOptions::default() }, matches, bar)
}

/// Starts the page of curves.
///
/// # Errors
/// `Io` when the port is in use.
pub fn of_curves(
    title: &str,
    curves: CurveSource,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<Option<Viewer>> {
    start(
        ViewerOptions { title: title.to_owned(), curves: Some(curves), ..ViewerOptions::default() },
        matches,
        bar,
    )
}

fn start(options: ViewerOptions, matches: &ArgMatches, bar: &ProgressBar) -> Result<Option<Viewer>> {
    let Some(address) = matches.get_one::<SocketAddr>(VIEW) else {
        return match options.is_writable {
            true => Err(Error::invalid_param("--view-write is for the page of --view; add --view")),
            false => Ok(None),
        };
    };
    let viewer = Viewer::bind(*address, options)?;
    // With --quiet, too: without its address, which may have a token, nobody can open the page.
    bar.suspend(|| eprintln!("viewer: {}", viewer.url()));
    Ok(Some(viewer))
}

/// Displays an item with each of its outputs.
pub fn show(viewer: &Viewer, item: &Item, outputs: &[Outputs], timings: Timings) {
    let Timings { pre, session, post, .. } = timings;
    for outputs in outputs {
        viewer.show(Shown {
            stages: vec![("pre", pre), ("network", session), ("post", post)],
            ..shown(item.path().display().to_string(), item.number(), item.value(), outputs)
        });
    }
}

/// Returns an item with its outputs, without latencies.
pub fn shown(name: String, index: u64, input: ValueRef<'_>, outputs: &Outputs) -> Shown {
    Shown {
        name,
        index,
        input: input.to_value(),
        outputs: outputs.iter().map(|(name, value)| (name.to_owned(), value.clone())).collect(),
        notes: Vec::new(),
        stages: Vec::new(),
    }
}

/// The speed at which `opendr view` displays items: that of the video, or one a second.
#[derive(Default)]
pub struct Pace {
    stream: Option<(Arc<Path>, Instant)>,
}

impl Pace {
    /// Waits until the item is due, or until Ctrl-C.
    pub fn wait(&mut self, item: &Item) {
        let Datum::Frame(frame) = &item.datum else { return sleep(STILL) };
        let Some(video) = &frame.video else { return sleep(STILL) };
        let due = frame.frame_index as f64 / video.frame_rate;
        // A camera has no frame rate before it delivers frames, which then are due at once.
        let Ok(due) = Duration::try_from_secs_f64(due) else { return };
        match &self.stream {
            Some((path, begin)) if *path == frame.path => sleep(due.saturating_sub(begin.elapsed())),
            _ => self.stream = Instant::now().checked_sub(due).map(|begin| (frame.path.clone(), begin)),
        }
    }
}

/// Waits until Ctrl-C.
pub fn wait_for_interrupt() {
    while !interrupted() {
        thread::sleep(POLL);
    }
}

/// Waits for `time`, or until Ctrl-C.
pub fn sleep(time: Duration) {
    let begin = Instant::now();
    while !interrupted() && begin.elapsed() < time {
        thread::sleep(POLL.min(time.saturating_sub(begin.elapsed())));
    }
}
