//! `opendr bench`: how fast a learner is here, stage by stage.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::data::{Image, Layout, PixelFormat};
use opendr::learner::{AnyLearner, Ports};
use opendr::vision;
use opendr::{Error, Progress, Result, Unit};
use serde::Serialize;

use crate::exit::Outcome;
use crate::progress_bar::Bar;
use crate::timings::Timings;
use crate::{learner_flags, loading};

pub fn grammar() -> Command {
    let count = |name: &'static str, default: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_parser(value_parser!(usize)).default_value(default).value_name("N").help(help)
    };
    Command::new("bench")
        .about("Measure a learner: p50 and p99 of each stage, frames a second, peak memory")
        .arg(Arg::new("learner").required(true).value_name("LEARNER[/VARIANT]").help("What to measure"))
        .arg(
            Arg::new("input")
                .value_parser(value_parser!(PathBuf))
                .value_name("PICTURE")
                .help("What to run on; a drawn 1920x1080 picture otherwise"),
        )
        .arg(count("frames", "100", "Frames to measure"))
        .arg(count("warmup", "10", "Frames before that"))
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print JSON"))
        .args(loading::flags())
        .after_help("Examples:\n  opendr bench centernet\n  opendr bench yunet faces.jpg --threads 1 --json")
}

#[derive(Serialize)]
struct Report {
    learner: String,
    runtime: String,
    device: String,
    picture: [usize; 2],
    frames: usize,
    frames_per_second: f64,
    p50_ms: Timings,
    p99_ms: Timings,
    peak_memory_mb: Option<f64>,
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    loading::set_threads(matches);
    let spec = matches.get_one::<String>("learner").map_or("", String::as_str);
    let entry = loading::entry(spec)?;
    let [frames, warmup] = ["frames", "warmup"].map(|name| matches.get_one(name).copied().unwrap_or(1));
    if frames == 0 {
        return Err(Error::invalid_param("frames = 0: give at least 1"));
    }
    let bar = Bar::new(matches.get_flag("quiet"));
    let mut learner = loading::load(spec, entry, matches, &bar)?;
    let image = match matches.get_one::<PathBuf>("input") {
        Some(path) => vision::open(path)?,
        None => drawn_picture(1920, 1080)?,
    };
    let further = learner_flags::ports(entry, matches)?;
    let ports = further.iter().fold(Ports::one(&image), |ports, (name, value)| ports.with(name, value));
    let timings = measure(learner.as_mut(), &ports, warmup, frames, &bar)?;
    let report = Report {
        learner: spec.to_owned(),
        runtime: loading::runtime(matches)?,
        device: learner.device().to_string(),
        picture: [image.width(), image.height()],
        frames,
        frames_per_second: 1e3 * frames as f64 / timings.iter().map(|one| one.total).sum::<f64>(),
        p50_ms: percentile(&timings, 0.50),
        p99_ms: percentile(&timings, 0.99),
        peak_memory_mb: peak_memory_mb(),
    };
    print(&report, matches.get_flag("json"))?;
    Ok(Outcome::Done)
}

fn measure(
    learner: &mut dyn AnyLearner,
    ports: &Ports<'_>,
    warmup: usize,
    frames: usize,
    bar: &Bar,
) -> Result<Vec<Timings>> {
    bar.begin("measuring", Some((warmup + frames) as u64), Unit::Items);
    let mut timings = Vec::with_capacity(frames);
    for frame in 0..warmup + frames {
        let (_, one) = Timings::of(|| learner.infer(ports))?;
        if frame >= warmup {
            timings.push(one);
        }
        bar.advance(1);
        if bar.stopped() {
            break;
        }
    }
    bar.end();
    Ok(timings)
}

/// Each stage's own percentile.
fn percentile(timings: &[Timings], part: f64) -> Timings {
    let of = |stage: fn(&Timings) -> f64| {
        let mut values: Vec<f64> = timings.iter().map(stage).collect();
        values.sort_by(f64::total_cmp);
        let at = ((values.len() as f64 * part).ceil() as usize).clamp(1, values.len().max(1)) - 1;
        values.get(at).copied().unwrap_or_default()
    };
    Timings { pre: of(|t| t.pre), session: of(|t| t.session), post: of(|t| t.post), total: of(|t| t.total) }
}

fn print(report: &Report, json: bool) -> Result<()> {
    if json {
        let text = serde_json::to_string_pretty(report);
        println!("{}", text.map_err(|error| Error::internal("no JSON").with_source(error))?);
        return Ok(());
    }
    let Report { learner, runtime, picture: [width, height], frames, p50_ms, p99_ms, .. } = report;
    println!("{learner} on {runtime}");
    println!("{frames} frames of {width}x{height}: {:.1} frames a second", report.frames_per_second);
    println!("p50: {p50_ms}\np99: {p99_ms}");
    if let Some(peak) = report.peak_memory_mb {
        println!("peak memory: {peak:.0} MB");
    }
    Ok(())
}

/// Most memory that the process has had, in 10^6 bytes; Linux tells it.
fn peak_memory_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024.0 / 1e6)
}

/// Gradients and bars: nothing to find, everything to compute.
fn drawn_picture(width: usize, height: usize) -> Result<Image> {
    let pixel = |at: usize| {
        let (x, y) = (at % width, at / width);
        [(x * 255 / width) as u8, (y * 255 / height) as u8, if x / 64 % 2 == y / 64 % 2 { 200 } else { 40 }]
    };
    let samples: Vec<u8> = (0..width * height).flat_map(pixel).collect();
    Image::new(samples, width, height, PixelFormat::Rgb, Layout::Hwc)
}
