//! experiment
use std::ops::ControlFlow;
use opendr_engine::Result;
use opendr_engine::params::Params as _;
use opendr_kernels::Compute;
use opendr_rl::{Algorithm as _, EvaluationProtocol, Ppo, PpoConfig};
use opendr_simulation::make;
use opendr_simulation::uav_corridor::Remembered;
use opendr_simulation::vector::{Autoreset, EnvironmentVector, VecEnvironment as _};
use opendr_engine::environment::Environment;
fn cpu() -> f64 { let s = std::fs::read_to_string("/proc/self/stat").unwrap(); let v: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect(); (v[11].parse::<f64>().unwrap() + v[12].parse::<f64>().unwrap()) / 100.0 }
struct Harsh<E>(E, f64, f64);
impl<E: Environment> Environment for Harsh<E> {
    fn spec(&self) -> &opendr_engine::environment::EnvironmentSpec { self.0.spec() }
    fn reset(&mut self, s: Option<u64>, o: &opendr_engine::environment::ResetOptions, ob: &mut [f32]) -> Result<opendr_engine::environment::Info> { self.0.reset(s, o, ob) }
    fn step(&mut self, a: &[f32], ob: &mut [f32]) -> Result<opendr_engine::environment::Step> { let mut s = self.0.step(a, ob)?;
        if s.terminated && s.info.get("success") != Some(1.0) { s.reward = -20.0 - self.1 } else if s.reward < 0.0 { s.reward *= self.2; } Ok(s) }
}
fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let mut config = PpoConfig { n_steps: 128, batch_size: 64, ..PpoConfig::default() };
    let (mut envs, mut steps, mut threads, mut eval, mut train) = (8usize, 300_000u64, 2usize, 500u64, "UavDepthCorridor-v1".to_owned());
    let (mut harsh, mut mild) = (0.0, 1.0); let mut seeds = vec![0u64];
    let mut file = None;
    for a in &args { let (k, v) = a.split_once('=').unwrap(); match k { "harsh" => harsh = v.parse().unwrap(), "mild" => mild = v.parse().unwrap(), "envs" => envs = v.parse().unwrap(), "steps" => steps = v.parse().unwrap(), "threads" => threads = v.parse().unwrap(), "eval" => eval = v.parse().unwrap(), "train" => train = v.to_owned(), "file" => file = Some(v.to_owned()),
        "seeds" => seeds = v.split(',').map(|s| s.parse().unwrap()).collect(), _ => config.set_text(k, v)? } }
    for seed in seeds {
        config.seed = seed;
        let begun = std::time::Instant::now(); let c0 = cpu();
        let ids: Vec<&str> = train.split(',').collect();
        let worlds = (0..envs).map(|i| Ok(Box::new(Harsh(Remembered::new(make(ids[i % ids.len()])?)?, harsh, mild)) as Box<dyn Environment>)).collect::<Result<Vec<_>>>()?;
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
            let (mut memory, compute) = (Default::default(), Compute::single());
            let hits = std::cell::Cell::new(0);
            let mut act = |o: &[f32], a: &mut [f32]| ppo.policy().act(&compute, o, opendr_rl::Acting::Deterministic, &mut memory, a);
            let r = opendr_rl::evaluate_controller(&mut act, &mut world, &protocol, &|s| { hits.set(hits.get() + u32::from(s.info.get("collision") == Some(1.0))); s.info.get("success").map(|s| s > 0.5) })?;
            print!(" {} {:.1} (hit {} ret {:.1} trunc {})", &id[16..], 100.0 * r.success.unwrap().rate, hits.get(), r.mean_return, r.episodes.iter().filter(|e| !e.terminated).count());
        }
        println!();
    }
    Ok(())
}
