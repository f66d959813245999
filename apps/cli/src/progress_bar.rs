//! Progress on the terminal, and Ctrl-C.

use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use opendr::{Progress, Unit};

use crate::progress_lines::ProgressLines;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Exit code of the second Ctrl-C, as shells have it.
const INTERRUPTED_CODE: i32 = 130;

/// Whether Ctrl-C was pressed.
pub fn interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// From now on the first Ctrl-C asks the work to end after what is in hand, the second ends the process.
fn watch_interrupt() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let handler = || {
            if INTERRUPTED.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED_CODE);
            }
        };
        // Without a handler Ctrl-C ends the process at once, which is no worse than before.
        ctrlc::set_handler(handler).ok();
    });
}

/// Progress on standard error: a bar where that is a terminal, else a line now and then.
pub struct Bar {
    shown: Mutex<Shown>,
    quiet: bool,
}

enum Shown {
    Nothing,
    Bar(ProgressBar, String),
    Lines(ProgressLines),
}

impl Bar {
    /// A bar, or nothing at all when `quiet`. From here on Ctrl-C only asks to stop.
    pub fn new(quiet: bool) -> Self {
        watch_interrupt();
        Self::without_interrupt(quiet)
    }

    /// As [`Bar::new`], for a process whose Ctrl-C is somebody else's.
    pub fn without_interrupt(quiet: bool) -> Self {
        Self { shown: Mutex::new(Shown::Nothing), quiet }
    }

    /// Whether it is drawn anew all the time, on a terminal.
    pub fn is_live(&self) -> bool {
        matches!(&*self.shown(), Shown::Bar(..))
    }

    /// Prints to standard output or error without tearing the bar.
    pub fn suspend<R>(&self, print: impl FnOnce() -> R) -> R {
        match &*self.shown() {
            Shown::Bar(bar, _) => bar.suspend(print),
            _ => print(),
        }
    }

    fn shown(&self) -> MutexGuard<'_, Shown> {
        self.shown.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Progress for Bar {
    fn begin(&self, what: &str, total: Option<u64>, unit: Unit) {
        if !self.quiet {
            *self.shown() = match stderr().is_terminal() {
                true => Shown::Bar(bar(what, total, unit), what.to_owned()),
                false => Shown::Lines(ProgressLines::begin(what, total, unit)),
            };
        }
    }

    fn advance(&self, amount: u64) {
        match &mut *self.shown() {
            Shown::Nothing => {}
            Shown::Bar(bar, _) => bar.inc(amount),
            Shown::Lines(lines) => lines.advance(amount),
        }
    }

    fn end(&self) {
        if let Shown::Bar(bar, _) = std::mem::replace(&mut *self.shown(), Shown::Nothing) {
            bar.finish_and_clear();
        }
    }

    fn status(&self, text: &str) {
        match &mut *self.shown() {
            Shown::Nothing => {}
            Shown::Bar(bar, what) => bar.set_message(format!("{what}: {text}")),
            Shown::Lines(lines) => lines.status(text),
        }
    }

    fn note(&self, line: &str) {
        if !self.quiet {
            self.suspend(|| eprintln!("{line}"));
        }
    }

    fn stopped(&self) -> bool {
        interrupted()
    }
}

fn bar(what: &str, total: Option<u64>, unit: Unit) -> ProgressBar {
    let template = match (unit, total) {
        (Unit::Bytes, Some(_)) => "{msg} {wide_bar} {bytes}/{total_bytes} {bytes_per_sec} ETA {eta}",
        (Unit::Bytes, None) => "{msg} {spinner} {bytes} {bytes_per_sec}",
        (_, Some(_)) => "{msg} {wide_bar} {pos}/{len} {per_sec} ETA {eta}",
        (_, None) => "{msg} {spinner} {pos} {per_sec}",
    };
    let bar = ProgressBar::with_draw_target(total, ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.set_message(what.to_owned());
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
