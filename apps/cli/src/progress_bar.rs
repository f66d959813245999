//! Progress on the terminal, and handling of Ctrl-C.

use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};
use std::time::Duration;

use indicatif::{ProgressDrawTarget, ProgressStyle};
use opendr::{Progress, Unit};

use crate::progress_lines::ProgressLines;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Exit code of the second Ctrl-C, as in shells.
const INTERRUPTED_CODE: i32 = 130;

/// Returns whether Ctrl-C was pressed.
pub fn interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Installs the handler: the first Ctrl-C requests an orderly stop, the second ends the process.
fn watch_interrupt() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let handler = || {
            if INTERRUPTED.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED_CODE);
            }
        };
        // Without a handler Ctrl-C ends the process at once, as by default.
        ctrlc::set_handler(handler).ok();
    });
}

/// Progress on standard error: a bar on a terminal, else a line every few seconds.
pub struct ProgressBar {
    state: Mutex<State>,
    quiet: bool,
}

enum State {
    Idle,
    Bar(indicatif::ProgressBar, String),
    Lines(ProgressLines),
}

impl ProgressBar {
    /// Creates a progress display, which prints nothing when `quiet`, and installs the handler of Ctrl-C.
    pub fn new(quiet: bool) -> Self {
        watch_interrupt();
        Self::without_interrupt(quiet)
    }

    /// As [`ProgressBar::new`], without the handler of Ctrl-C, for processes that have their own.
    pub fn without_interrupt(quiet: bool) -> Self {
        Self { state: Mutex::new(State::Idle), quiet }
    }

    /// Returns whether a bar is shown on a terminal.
    pub fn is_live(&self) -> bool {
        matches!(&*self.state(), State::Bar(..))
    }

    /// Prints to standard output or error without tearing the bar.
    pub fn suspend<R>(&self, print: impl FnOnce() -> R) -> R {
        match &*self.state() {
            State::Bar(bar, _) => bar.suspend(print),
            _ => print(),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Progress for ProgressBar {
    fn begin(&self, what: &str, total: Option<u64>, unit: Unit) {
        if !self.quiet {
            *self.state() = match stderr().is_terminal() {
                true => State::Bar(bar(what, total, unit), what.to_owned()),
                false => State::Lines(ProgressLines::begin(what, total, unit)),
            };
        }
    }

    fn advance(&self, amount: u64) {
        match &mut *self.state() {
            State::Idle => {}
            State::Bar(bar, _) => bar.inc(amount),
            State::Lines(lines) => lines.advance(amount),
        }
    }

    fn advance_resumed(&self, amount: u64) {
        match &mut *self.state() {
            State::Idle => {}
            State::Bar(bar, _) => {
                bar.inc(amount);
                bar.reset_eta();
            }
            State::Lines(lines) => lines.advance_resumed(amount),
        }
    }

    fn end(&self) {
        if let State::Bar(bar, _) = std::mem::replace(&mut *self.state(), State::Idle) {
            bar.finish_and_clear();
        }
    }

    fn status(&self, text: &str) {
        match &mut *self.state() {
            State::Idle => {}
            State::Bar(bar, what) => bar.set_message(format!("{what}: {text}")),
            State::Lines(lines) => lines.status(text),
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

fn bar(what: &str, total: Option<u64>, unit: Unit) -> indicatif::ProgressBar {
    let template = match (unit, total) {
        (Unit::Bytes, Some(_)) => "{msg} {wide_bar} {bytes}/{total_bytes} {bytes_per_sec} ETA {eta}",
        (Unit::Bytes, None) => "{msg} {spinner} {bytes} {bytes_per_sec}",
        (_, Some(_)) => "{msg} {wide_bar} {pos}/{len} {per_sec} ETA {eta}",
        (_, None) => "{msg} {spinner} {pos} {per_sec}",
    };
    let bar = indicatif::ProgressBar::with_draw_target(total, ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.set_message(what.to_owned());
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
