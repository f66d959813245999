//! Temporary: trial ID STEPS ENVS EVAL_EPISODES SEED [env.k=v] [k=v] [also=ID]
use std::time::Instant;
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::Result;
use opendr_rl::*;
use opendr_simulation::vector::{Autoreset, VectorOptions};
use opendr_simulation::Registry;

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (id, steps, envs, episodes, seed) = (&args[0], args[1].parse::<u64>().unwrap(), args[2].parse::<usize>().unwrap(), args[3].parse::<u64>().unwrap(), args[4].parse::<u64>().unwrap());
    let mut config = PpoConfig { seed, ..PpoConfig::default() };
    let mut train = ParamMap::new(); let mut test = ParamMap::new(); let mut also = vec![];
    let reg = Registry::builtin().get(id)?;
    let parse = |k: &str, v: &str| reg.fields().iter().find(|f| f.name == k).expect(k).parse(v);
    for a in &args[5..] {
        let (k, v) = a.split_once('=').unwrap();
        if let Some(k) = k.strip_prefix("env.") { train.insert(k.into(), parse(k, v)?); test.insert(k.into(), parse(k, v)?); }
        else if let Some(k) = k.strip_prefix("train.") { train.insert(k.into(), parse(k, v)?); }
        else if k == "also" { also.push(v.to_owned()); }
        else { config.set_text(k, v)?; }
    }
    let mut worlds = reg.make_vec(&train, VectorOptions { autoreset: Autoreset::SameStep, ..VectorOptions::new(envs) })?;
    let mut ppo = Ppo::new(&config, worlds.spec())?;
    let begun = Instant::now();
    let parts = 8;
    for part in 1..=parts {
        let mut r = None;
        while ppo.report().timesteps < steps * part / parts { r = Some(ppo.iterate(&mut *worlds, steps)?); }
        let secs = begun.elapsed().as_secs_f64();
        let n = if part == parts { episodes } else { 100 };
        let first = if part == parts { 1_000_000 } else { 2_000_000 };
        for test_id in std::iter::once(id).chain(also.iter().filter(|_| part == parts)) {
            let mut env = Registry::builtin().get(test_id)?.make(&test)?;
            let rep = evaluate(ppo.policy(), &mut *env, &EvaluationProtocol { episodes: n, first_seed: first, ..Default::default() })?;
            println!("{test_id} {} {secs:.0}s train {:?} return {:.2} len {:.0} success {:?}", ppo.report().timesteps, r.as_ref().map(|r| r.mean_return), rep.mean_return, rep.mean_length, rep.success.map(|s| (s.rate, s.interval)));
        }
    }
    std::fs::write(std::env::temp_dir().join(format!("trial-{}-{seed}.safetensors", std::process::id())), ppo.policy().to_bytes()?).ok();
    Ok(())
}
