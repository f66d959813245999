//! experiment
use std::ops::ControlFlow;
use opendr_engine::Result;
use opendr_engine::params::Params as _;
use opendr_kernels::Compute;
use opendr_rl::{Algorithm as _, EvaluationProtocol, Ppo, PpoConfig, evaluate};
use opendr_simulation::make;
use opendr_simulation::uav_corridor::Remembered;
use opendr_simulation::vector::{Autoreset, EnvironmentVector, VecEnvironment as _};
use opendr_engine::environment::Environment;
fn cpu() -> f64 { let s = std::fs::read_to_string("/proc/self/stat").unwrap(); let v: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect(); (v[11].parse::<f64>().unwrap() + v[12].parse::<f64>().unwrap()) / 100.0 }
fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let mut config = PpoConfig { n_steps: 128, batch_size: 64, ..PpoConfig::default() };
    let (mut envs, mut steps, mut threads, mut eval, mut train) = (8usize, 300_000u64, 2usize, 500u64, "UavDepthCorridor-v1".to_owned());
    let mut seeds = vec![0u64];
    let mut file = None;
    for a in &args { let (k, v) = a.split_once('=').unwrap(); match k { "envs" => envs = v.parse().unwrap(), "steps" => steps = v.parse().unwrap(), "threads" => threads = v.parse().unwrap(), "eval" => eval = v.parse().unwrap(), "train" => train = v.to_owned(), "file" => file = Some(v.to_owned()),
        "seeds" => seeds = v.split(',').map(|s| s.parse().unwrap()).collect(), _ => config.set_text(k, v)? } }
    for seed in seeds {
        config.seed = seed;
        let begun = std::time::Instant::now(); let c0 = cpu();
        let ids: Vec<&str> = train.split(',').collect();
        let worlds = (0..envs).map(|i| Ok(Box::new(Remembered::new(make(ids[i % ids.len()])?)?) as Box<dyn Environment>)).collect::<Result<Vec<_>>>()?;
        let mut worlds = EnvironmentVector::new(worlds, Autoreset::SameStep, threads)?;
        let mut ppo = Ppo::new(&config, worlds.spec())?.with_compute(Compute::with_threads(threads));
        let mut next = 50_000;
        let mut train = 0.0;
        ppo.train(&mut worlds, steps, &mut |event| {
            if event.report.timesteps >= next { next += 50_000;
                print!(" {}k:{:.0}%/{:.1}", event.report.timesteps / 1000, 100.0 * event.report.success_rate.unwrap_or(0.0), event.report.mean_return.unwrap_or(0.0)); }
            train = event.report.metrics.get("std").unwrap_or(0.0);
            Ok(ControlFlow::Continue(()))
        })?;
        let (w, c) = (begun.elapsed().as_secs_f64(), cpu() - c0);
        println!(" std {train:.2}"); print!("seed {seed}: {w:.1} s, {c:.1} cpu-s;");
        if let Some(file) = &file { ppo.policy().save(std::path::Path::new(&format!("{file}{seed}")))?; }
        for id in ["UavDepthCorridor-v1", "UavDepthCorridor-dense-v1", "UavDepthCorridor-noisy-v1", "UavDepthCorridor-dyn-v1"] {
            let mut world = Remembered::new(make(id)?)?;
            let protocol = EvaluationProtocol { episodes: if id.len() < 20 { eval } else { eval.min(500) }, ..EvaluationProtocol::default() };
            let r = evaluate(ppo.policy(), &mut world, &protocol)?;
            print!(" {} {:.1} (ret {:.1} trunc {})", &id[16..], 100.0 * r.success.unwrap().rate, r.mean_return, r.episodes.iter().filter(|e| !e.terminated).count());
        }
        println!();
    }
    Ok(())
}
