//! `opendr bench`: measures the speed of a learner, stage by stage.

mod layers;
mod synthetic;
mod workload;

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::environment::{Controller as _, Environment, EnvironmentSource as _, ResetOptions};
use opendr::inference::{SessionOptions, describe};
use opendr::learner::{AnyLearner, Entry, Ports};
use opendr::{Error, JsonFormat, PolicyController, Progress, Result, Unit};
use serde::Serialize;

use self::layers::{LayerReport, ProfiledCall};
use self::workload::{Input, Workload};
use crate::exit::Outcome;
use crate::peak_memory::peak_memory_mb;
use crate::progress_bar::ProgressBar;
use crate::timings::Timings;
use crate::{environment_flags, learner_flags, loading, stdout};

const EXAMPLES: &str = "\
Examples:
  opendr bench LEARNER
  opendr bench LEARNER faces.jpg --threads 1 --json
  opendr bench whisper talk.wav                     audio, with the real-time factor: time over duration
  opendr bench ppo --env CartPole-v1                a policy in its environment
  OPENDR_RUNTIME=builtin opendr bench LEARNER --layers --trace trace.json
                                                    the layers of its networks; ui.perfetto.dev shows the trace";

pub fn grammar() -> Command {
    let count = |name: &'static str, default: &'static str| {
        let number = value_parser!(u32).range(1..=1_000_000);
        Arg::new(name).long(name).value_parser(number).default_value(default).value_name("N")
    };
    Command::new("bench")
        .about("Measure a learner: p50 and p99 of each stage, frames per second, peak memory")
        .arg(loading::learner())
        .arg(
            Arg::new("input").value_parser(value_parser!(PathBuf)).value_name("FILE").help(
                "File to run on [default: a sample of the zoo, images at 1920x1080, or synthetic data]",
            ),
        )
        .arg(count("frames", "100").help("Number of frames, or steps of a policy, to measure"))
        .arg(count("warmup", "10").help("Number of frames, or steps, before the measurement"))
        .arg(
            Arg::new("json")
                .long("json")
                .action(ArgAction::SetTrue)
                .help("Print JSON (docs/command-line.md)"),
        )
        .arg(
            Arg::new("layers").long("layers").action(ArgAction::SetTrue).help(
                "Profile the layers of the networks too: time, GFLOP/s, GB/s and share of the machine's peak (built-in runtime)",
            ),
        )
        .arg(
            Arg::new("trace")
                .long("trace")
                .value_parser(value_parser!(PathBuf))
                .value_name("FILE")
                .requires("layers")
                .help("Write the first profiled calls as trace events, which ui.perfetto.dev shows"),
        )
        .args(loading::flags())
        .after_help(EXAMPLES)
}

/// Format of the measurement as JSON. Version 2 renamed the inputs `picture` and `sound` to `image` and `audio`, and `piece_s` and
/// `of` to `chunk_s` and `type`.
const FORMAT: JsonFormat = JsonFormat::new("measurement", 2);

#[derive(Serialize)]
struct Measurement {
    learner: String,
    runtime: String,
    device: String,
    threads: usize,
    #[serde(flatten)]
    workload: Workload,
    frames: usize,
    frames_per_second: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    real_time_factor: Option<f64>,
    p50_ms: Timings,
    p99_ms: Timings,
    peak_memory_mb: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    layers: Option<LayerReport>,
}

/// Calls that are profiled after the measurement.
const PROFILED: usize = 30;

/// The calls of a learner, measured and profiled.
struct Measured {
    timings: Vec<Timings>,
    profiles: Vec<ProfiledCall>,
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let spec = matches.get_one::<String>(loading::LEARNER).map_or("", String::as_str);
    let entry = loading::entry(spec)?;
    let options = SessionOptions::from(loading::device(matches)?);
    if matches.get_flag("layers") {
        layers::check_runtime(options.device)?;
    }
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let mut learner = loading::load(spec, &learner_flags::params(entry, matches)?, matches, &bar)?;
    let (workload, Measured { timings, profiles }) = match environment_flags::is_policy(entry) {
        true => measure_policy(learner.as_ref(), entry, matches, &bar)?,
        false => measure_inference(learner.as_mut(), spec, entry, matches, &bar)?,
    };
    if let Some(path) = matches.get_one::<PathBuf>("trace") {
        layers::write_trace(spec, &profiles, path)?;
    }
    // The clock may not advance during a very fast call; 1 ns avoids a division by zero.
    let mean_s = (1e-3 * timings.iter().map(|one| one.total).sum::<f64>() / timings.len() as f64).max(1e-9);
    let measurement = Measurement {
        learner: spec.to_owned(),
        runtime: match timings.iter().any(|one| one.session > 0.0) {
            true => describe(options)?,
            false => "its own kernels".to_owned(),
        },
        device: learner.device().to_string(),
        threads: options.thread_count()?,
        real_time_factor: match workload {
            Workload::Audio { chunk_s, .. } => Some(mean_s / chunk_s),
            _ => None,
        },
        workload,
        frames: timings.len(),
        frames_per_second: mean_s.recip(),
        p50_ms: percentile(&timings, 0.50),
        p99_ms: percentile(&timings, 0.99),
        // Before the limits of the machine are measured, which takes memory of its own.
        peak_memory_mb: peak_memory_mb(),
        layers: match matches.get_flag("layers") {
            true => Some(LayerReport::new(&profiles, options.thread_count()?)?),
            false => None,
        },
    };
    print(&measurement, matches.get_flag("json"))?;
    Ok(Outcome::Done)
}

/// Measures inference on images, audio or other values.
fn measure_inference(
    learner: &mut dyn AnyLearner,
    spec: &str,
    entry: &'static Entry,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<(Workload, Measured)> {
    let (workload, inputs) = workload::inputs(spec, entry, matches, bar)?;
    let in_chunks = matches!(workload, Workload::Audio { .. }) && entry.capabilities.streaming;
    let mut frame = 0;
    let measured = measure(matches, bar, || {
        let mut ports = Ports::default();
        for Input { port, values } in inputs.iter().filter(|input| frame == 0 || !input.port.init) {
            let value = values.get(frame % values.len().max(1)).ok_or_else(|| {
                Error::invalid_input("the audio is shorter than one chunk of 0.1 s; name a longer file")
            })?;
            ports = ports.with(port.name, value);
        }
        frame += 1;
        let ((), timings) = Timings::of(|| match in_chunks {
            true => learner.push(Some(&ports), &mut |_| ()),
            false => learner.infer(&ports).map(drop),
        })?;
        Ok(timings)
    })?;
    Ok((workload, measured))
}

/// Measures a policy during episodes, without the time of the environment.
fn measure_policy(
    learner: &dyn AnyLearner,
    entry: &'static Entry,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<(Workload, Measured)> {
    let source = environment_flags::source(matches, Some(learner))?;
    let mut environment = source.make()?;
    let mut stream = PolicyController::new(learner.stream()?, entry, environment.spec())?;
    let mut observation = vec![0.0; environment.spec().observation.len()];
    let mut action = vec![0.0; environment.spec().action.len()];
    let begin = |environment: &mut dyn Environment, seed, observation: &mut [f32]| {
        environment.reset(seed, &ResetOptions::new(), observation).map(drop)
    };
    begin(environment.as_mut(), Some(0), &mut observation)?;
    let measured = measure(matches, bar, || {
        let ((), timings) = Timings::of(|| stream.act(&observation, &mut action))?;
        if environment.step(&action, &mut observation)?.is_over() {
            begin(environment.as_mut(), None, &mut observation)?;
            stream.reset();
        }
        Ok(timings)
    })?;
    Ok((Workload::Environment(source.id().to_owned()), measured))
}

/// Returns the timings of `--frames` calls after `--warmup` calls, and with `--layers` the profiles of further ones.
fn measure(
    matches: &ArgMatches,
    bar: &ProgressBar,
    mut call: impl FnMut() -> Result<Timings>,
) -> Result<Measured> {
    let [frames, warmup] =
        ["frames", "warmup"].map(|name| matches.get_one::<u32>(name).map_or(1, |&count| count as usize));
    let profiled = if matches.get_flag("layers") { frames.min(PROFILED) } else { 0 };
    bar.begin("measuring", Some((warmup + frames + profiled) as u64), Unit::Items);
    let mut measured =
        Measured { timings: Vec::with_capacity(frames), profiles: Vec::with_capacity(profiled) };
    for frame in 0..warmup + frames + profiled {
        let done = if frame < warmup + frames {
            call().map(|one| {
                if frame >= warmup {
                    measured.timings.push(one)
                }
            })
        } else {
            ProfiledCall::of(&mut call).map(|profile| measured.profiles.push(profile))
        };
        done.inspect_err(|_| bar.end())?;
        bar.advance(1);
        if bar.stopped() {
            break;
        }
    }
    bar.end();
    Ok(measured)
}

/// Returns the percentile of each stage by itself (nearest rank).
fn percentile(timings: &[Timings], part: f64) -> Timings {
    let of = |stage: fn(&Timings) -> f64| {
        let mut values: Vec<f64> = timings.iter().map(stage).collect();
        values.sort_by(f64::total_cmp);
        let rank = (values.len() as f64 * part).ceil() as usize;
        values.get(rank.saturating_sub(1)).copied().unwrap_or_default()
    };
    Timings { pre: of(|t| t.pre), session: of(|t| t.session), post: of(|t| t.post), total: of(|t| t.total) }
}

fn print(measurement: &Measurement, json: bool) -> Result<()> {
    if json {
        return stdout::print_pretty_json(FORMAT, measurement);
    }
    let Measurement { learner, runtime, workload, frames, frames_per_second, p50_ms, p99_ms, .. } =
        measurement;
    let workload = match workload {
        Workload::Image { source, width, height } => format!("frames of {width}x{height} ({source})"),
        Workload::Audio { source, sample_rate, chunk_s } => {
            format!("chunks of {chunk_s:.1} s at {sample_rate} Hz ({source})")
        }
        Workload::Values { source, value_type, .. } => format!("inputs {value_type} ({source})"),
        Workload::Environment(id) => format!("steps in {id}"),
    };
    let real_time = measurement
        .real_time_factor
        .map_or_else(String::new, |factor| format!(", real-time factor {factor:.3}"));
    let memory =
        measurement.peak_memory_mb.map_or_else(String::new, |peak| format!("\npeak memory: {peak:.0} MB"));
    stdout::print(format_args!(
        "{learner} on {runtime}\n\
         {frames} {workload}: {frames_per_second:.1} per second{real_time}\n\
         p50: {p50_ms}\np99: {p99_ms}{memory}"
    ))?;
    measurement.layers.as_ref().map_or(Ok(()), |layers| stdout::print(layers.to_string().trim_end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_per_stage() {
        let timings: Vec<_> = (1..=100)
            .map(|n| Timings { pre: f64::from(n), session: f64::from(101 - n), ..Timings::default() })
            .collect();
        let half = percentile(&timings, 0.5);
        assert_eq!((half.pre, half.session), (50.0, 50.0));
        assert_eq!(percentile(&timings, 0.99).session, 99.0);
        assert_eq!(percentile(&timings[..1], 0.99).session, 100.0);
    }
}
