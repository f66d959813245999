//! Peak memory of processes that open and run a model, and their times to open it.

use std::process::Command;
use std::time::Instant;

use opendr_engine::{Error, Result};
use opendr_inference::{Builtin, OnnxRuntime, Runtime, Session, SessionOptions};

use super::inputs::Owned;
use super::{MASK, median, name};

/// First argument of the processes that [`print`] starts.
pub const PART: &str = "part";
const SIDES: [&str; 2] = ["built-in", "onnxruntime"];
/// Processes per runtime and file; the medians are printed.
const PROCESSES: usize = 5;

/// Prints a line per file: peaks in MiB and times to open in milliseconds, with ratios.
///
/// # Errors
/// `Internal` when this program cannot be started again.
pub fn print(files: &[String], masks: bool) -> Result<()> {
    println!(
        "| model | built-in, MiB | ONNX Runtime, MiB | ratio | built-in opened in, ms | ONNX Runtime | ratio |"
    );
    println!("|---|---|---|---|---|---|---|");
    let mut logarithms = [const { Vec::new() }; 2];
    for file in files {
        let mut measured: [[Vec<f64>; SIDES.len()]; 2] = Default::default();
        let mut refused = String::new();
        for (side, given) in (0..PROCESSES).flat_map(|_| SIDES.into_iter().enumerate()) {
            match part(given, file, masks)? {
                Ok(figures) => {
                    measured.iter_mut().zip(figures).for_each(|(kind, figure)| kind[side].push(figure));
                }
                Err(message) => refused = message,
            }
        }
        print!("| `{}` |", name(file));
        for (kind, logarithms) in measured.iter().zip(&mut logarithms) {
            match kind.each_ref().map(|figures| median(figures)) {
                [Some(ours), Some(theirs)] => {
                    logarithms.push((ours / theirs).ln());
                    print!(" {ours:.1} | {theirs:.1} | {:.2} |", ours / theirs);
                }
                _ => print!(" refused: {refused} | | |"),
            }
        }
        println!();
    }
    for (kind, logarithms) in ["peak memory", "time to open"].iter().zip(&logarithms) {
        let mean = logarithms.iter().sum::<f64>() / logarithms.len().max(1) as f64;
        println!("# {kind}: geometric mean of {} ratios: {:.3}", logarithms.len(), mean.exp());
    }
    Ok(())
}

/// Returns peak and time of a process, or why it failed.
fn part(side: &str, file: &str, masks: bool) -> Result<std::result::Result<[f64; 2], String>> {
    let failed = |error| Error::internal(format!("starting this program again: {error}"));
    let mut command = Command::new(std::env::current_exe().map_err(failed)?);
    command.args(masks.then_some(MASK)).args([PART, side, file]);
    let output = command.output().map_err(failed)?;
    let text = String::from_utf8_lossy(&output.stdout);
    let figures: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let said = || String::from_utf8_lossy(&output.stderr).lines().next().unwrap_or("no output").to_owned();
    Ok(<[f64; 2]>::try_from(figures).map_err(|_| said()))
}

/// Opens and runs a model three times in one runtime; prints peak memory of this process in MiB and the time to open in milliseconds.
///
/// # Errors
/// The errors of the runtime.
pub fn print_part(side: &str, bytes: &[u8]) -> Result<()> {
    let onnx_runtime;
    let runtime: &dyn Runtime = if side == SIDES[0] {
        &Builtin
    } else {
        onnx_runtime = OnnxRuntime::find()?;
        &*onnx_runtime
    };
    let begun = Instant::now();
    let session =
        Session::open_with(runtime, bytes, SessionOptions { threads: 2, ..SessionOptions::default() })?;
    let opened = 1e3 * begun.elapsed().as_secs_f64();
    let owned: Vec<Owned> = session.inputs().iter().map(Owned::random).collect();
    let inputs = owned.iter().map(Owned::view).collect::<Result<Vec<_>>>()?;
    for _ in 0..3 {
        session.run(&inputs, |_| Ok(()))?;
    }
    println!("{:.2} {opened:.3}", peak()?);
    Ok(())
}

/// Returns the peak memory of this process in MiB.
fn peak() -> Result<f64> {
    let status = std::fs::read_to_string("/proc/self/status")
        .map_err(|error| Error::unsupported(format!("peak memory is read from /proc: {error}")))?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok())
        .map(|kibibytes| kibibytes / 1024.0)
        .ok_or_else(|| Error::internal("/proc/self/status has no VmHWM"))
}
