//! Prints a table of the built-in runtime and ONNX Runtime side by side on ONNX files, on random inputs, with one and
//! with two threads: `cargo run --release -p opendr-inference --example runtimes -- ROUNDS FILE...`.
//!
//! One line per file: medians of the times of a run in milliseconds, taking turns that begin with runs that are not
//! timed (with one thread, the time that the thread has computed, which other programs do not change much), their
//! ratio, the largest difference of an output relative to its largest magnitude, and the times to open the model. ONNX Runtime is found as by the library
//! (`ORT_DYLIB_PATH`). `runtimes memory FILE...` prints the peak memory of processes that open and run a model with
//! one runtime, and their times to open it. With `--avx2` first, CPUID reports neither AVX-512 nor AMX to both sides.
//! `runtimes layers FILE...` prints the nodes of models that take longest, with one thread and with two.

mod cpuid;
mod inputs;
mod memory;

use std::time::{Duration, Instant};

use opendr_engine::{Error, Result};
use opendr_executor::{Executor, LayerProfile};
use opendr_inference::{Builtin, OnnxRuntime, Runtime, Session, SessionOptions, TensorData, TensorView};
use opendr_kernels::Compute;

use inputs::Owned;

const THREADS: [usize; 2] = [1, 2];
/// Time for which a side runs before its turn is timed.
const SETTLING: Duration = Duration::from_millis(3);
/// Option that hides AVX-512 from both sides.
const MASK: &str = "--avx2";

fn main() -> Result<()> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let masks = arguments.first().is_some_and(|first| first == MASK);
    if masks {
        arguments.remove(0);
        cpuid::mask_avx512()?;
    }
    let [rounds, files @ ..] = arguments.as_slice() else {
        eprintln!(
            "usage: runtimes [{MASK}] ROUNDS FILE...\n       runtimes [{MASK}] memory FILE...\n       runtimes [{MASK}] layers FILE..."
        );
        return Ok(());
    };
    match (rounds.as_str(), files) {
        ("layers", _) => return files.iter().try_for_each(|file| print_layers(file, &read(file)?)),
        ("memory", _) => return memory::print(files, masks),
        (memory::PART, [side, file]) => return memory::print_part(side, &read(file)?),
        _ => {}
    }
    let rounds = rounds.parse().unwrap_or(15_usize).max(1);
    let onnx_runtime = OnnxRuntime::find()?;
    println!("# {}, {rounds} rounds, kernels: {}", onnx_runtime.describe(), opendr_kernels::Isa::best());
    print!("| model |");
    for threads in THREADS {
        print!(" built-in, {threads} thread(s) | ONNX Runtime | ratio |");
    }
    println!(" difference | opened in, ms |");
    println!("|---|{}---|---|", "---|---|---|".repeat(THREADS.len()));
    let mut logarithms = [const { Vec::new() }; THREADS.len()];
    for file in files {
        let bytes = read(file)?;
        print!("| `{}` |", name(file));
        let mut last = String::new();
        for (threads, logarithms) in THREADS.into_iter().zip(&mut logarithms) {
            let options = SessionOptions { threads, ..SessionOptions::default() };
            match compare(&bytes, &options, &*onnx_runtime, rounds) {
                Ok((columns, ratio, rest)) => {
                    print!(" {columns} |");
                    last = rest;
                    logarithms.extend(ratio.map(f64::ln));
                }
                Err(error) => print!(" {error:#} | | |"),
            }
        }
        println!(" {last} |");
    }
    for (threads, logarithms) in THREADS.into_iter().zip(&logarithms) {
        let mean = logarithms.iter().sum::<f64>() / logarithms.len().max(1) as f64;
        println!("# {threads} thread(s): geometric mean of {} ratios: {:.3}", logarithms.len(), mean.exp());
    }
    Ok(())
}

fn read(file: &str) -> Result<Vec<u8>> {
    std::fs::read(file).map_err(|error| Error::internal(format!("{file}: {error}")))
}

/// Returns the time that this thread has computed, or with several threads the time of day.
fn seconds(threads: usize) -> f64 {
    if threads == 1 {
        let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
        // SAFETY: the pointer is to a local value.
        if unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) } == 0 {
            return time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64;
        }
    }
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0.0, |time| time.as_secs_f64())
}

fn name(file: &str) -> &str {
    let start = file.rmatch_indices('/').nth(1).map_or(0, |(at, _)| at + 1);
    &file[start..]
}

/// Prints the times of the nodes of a model with one thread and with two, the longest first.
fn print_layers(file: &str, bytes: &[u8]) -> Result<()> {
    let infos = Session::open_with(&Builtin, bytes, SessionOptions::default())?.inputs().to_vec();
    let owned: Vec<Owned> = infos.iter().map(Owned::random).collect();
    let [single, two] = [layers(bytes, 1, &owned)?, layers(bytes, 2, &owned)?];
    let micros = |layer: &LayerProfile| 1e6 * layer.time.as_secs_f64();
    let totals = [&single, &two].map(|layers| layers.iter().map(micros).sum::<f64>());
    println!("# {file}: {:.3} ms with one thread, {:.3} ms with two", totals[0] / 1e3, totals[1] / 1e3);
    let mut both: Vec<(&LayerProfile, &LayerProfile)> = single.iter().zip(&two).collect();
    both.sort_by_key(|(layer, _)| std::cmp::Reverse(layer.time));
    for (layer, parallel) in both.iter().take(40) {
        let share = 100.0 * micros(layer) / totals[0];
        let (operator, name) = (&layer.operator, &layer.name);
        println!("{:>9.1} us {:>9.1} us {share:5.1} % {operator} {name}", micros(layer), micros(parallel));
    }
    Ok(())
}

/// Returns the shortest time of each step in 30 runs.
fn layers(bytes: &[u8], threads: usize, inputs: &[Owned]) -> Result<Vec<LayerProfile>> {
    let mut executor = Executor::open(bytes, Compute::with_threads(threads))?;
    let tensors: Vec<opendr_executor::Tensor<'_>> = inputs.iter().filter_map(Owned::of_executor).collect();
    let mut least: Vec<LayerProfile> = executor.profile(&tensors, &mut |_| Ok(()))?;
    for _ in 0..30 {
        for (least, new) in least.iter_mut().zip(executor.profile(&tensors, &mut |_| Ok(()))?) {
            least.time = least.time.min(new.time);
        }
    }
    Ok(least)
}

struct Opened {
    session: Option<Session>,
    opened: f64,
    times: Vec<f64>,
    refused: String,
}

fn open(runtime: &dyn Runtime, bytes: &[u8], options: &SessionOptions) -> Opened {
    let start = Instant::now();
    let (session, refused) = match Session::open_with(runtime, bytes, *options) {
        Ok(session) => (Some(session), String::new()),
        Err(error) => (None, error.to_string()),
    };
    Opened { session, opened: 1e3 * start.elapsed().as_secs_f64(), times: Vec::new(), refused }
}

fn median(figures: &[f64]) -> Option<f64> {
    let mut sorted = figures.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// Returns the columns of the times, the ratio of the medians, and the columns of difference and opening.
fn compare(
    bytes: &[u8],
    options: &SessionOptions,
    onnx_runtime: &dyn Runtime,
    rounds: usize,
) -> Result<(String, Option<f64>, String)> {
    let mut sides = [open(&Builtin, bytes, options), open(onnx_runtime, bytes, options)];
    let infos = sides.iter().find_map(|side| side.session.as_ref()).map_or(&[][..], Session::inputs).to_vec();
    let owned: Vec<Owned> = infos.iter().map(Owned::random).collect();
    let inputs = owned.iter().map(Owned::view).collect::<Result<Vec<_>>>()?;
    let mut outputs: Vec<Vec<(String, Vec<f64>)>> = vec![Vec::new(); sides.len()];
    for (side, kept) in sides.iter_mut().zip(&mut outputs) {
        let Some(session) = &side.session else { continue };
        let names: Vec<String> = session.outputs().iter().map(|output| output.name.clone()).collect();
        let ran = session.run(&inputs, |outputs| {
            kept.extend(names.iter().cloned().zip(outputs.iter().map(numbers)));
            Ok(())
        });
        if let Err(error) = ran {
            side.refused = error.to_string();
            side.session = None;
        }
    }
    for round in 0..rounds {
        for offset in 0..sides.len() {
            let side = &mut sides[(round + offset) % 2];
            let Some(session) = &side.session else { continue };
            // Small models run several times per turn, so that a turn is a millisecond.
            let runs = side
                .times
                .first()
                .map_or(1, |first| (1.0 / first.max(1e-3)).ceil().clamp(1.0, 50.0) as usize);
            // Threads of the other side spin for a while after its turn; none is timed before they sleep.
            let begun = Instant::now();
            while begun.elapsed() < SETTLING {
                session.run(&inputs, |_| Ok(()))?;
            }
            let start = seconds(options.threads);
            for _ in 0..runs {
                session.run(&inputs, |_| Ok(()))?;
            }
            side.times.push(1e3 * (seconds(options.threads) - start) / runs as f64);
        }
    }
    let time = |side: &Opened| {
        median(&side.times).map_or_else(|| format!("refused: {}", side.refused), |time| format!("{time:.3}"))
    };
    let ratio = median(&sides[0].times).zip(median(&sides[1].times)).map(|(ours, theirs)| ours / theirs);
    let columns = format!(
        "{} | {} | {}",
        time(&sides[0]),
        time(&sides[1]),
        ratio.map_or("-".to_owned(), |ratio| format!("{ratio:.2}")),
    );
    let [ours, theirs] = &sides;
    let rest =
        format!("{:.1e} | {:.0}, {:.0}", difference(&outputs[0], &outputs[1]), ours.opened, theirs.opened);
    Ok((columns, ratio, rest))
}

/// Returns the largest difference of an output, relative to its largest magnitude.
fn difference(a: &[(String, Vec<f64>)], b: &[(String, Vec<f64>)]) -> f64 {
    if a.is_empty() || b.is_empty() {
        return f64::NAN;
    }
    let mut worst = 0.0_f64;
    for ((name, a), (_, b)) in a.iter().zip(b) {
        let magnitude = b.iter().fold(f64::MIN_POSITIVE, |largest, value| largest.max(value.abs()));
        let apart = if a.len() == b.len() {
            a.iter()
                .zip(b)
                .map(|(a, b)| if a.is_nan() && b.is_nan() { 0.0 } else { (a - b).abs() })
                .fold(0.0, |m: f64, d| if d.is_nan() { f64::INFINITY } else { m.max(d) })
        } else {
            f64::INFINITY
        };
        if apart / magnitude > 1e-4 {
            eprintln!("  {name}: {:.1e} of {magnitude:.3e}", apart / magnitude);
        }
        worst = worst.max(apart / magnitude);
    }
    worst
}

fn numbers(tensor: &TensorView<'_>) -> Vec<f64> {
    match tensor.data() {
        TensorData::F32(data) => data.iter().map(|&value| f64::from(value)).collect(),
        TensorData::I32(data) => data.iter().map(|&value| f64::from(value)).collect(),
        TensorData::I64(data) => data.iter().map(|&value| value as f64).collect(),
        TensorData::U8(data) => data.iter().map(|&value| f64::from(value)).collect(),
        TensorData::I8(data) => data.iter().map(|&value| f64::from(value)).collect(),
        TensorData::Bool(data) => data.iter().map(|&value| f64::from(u8::from(value))).collect(),
        _ => Vec::new(),
    }
}
