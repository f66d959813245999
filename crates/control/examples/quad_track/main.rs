//! dev
mod base;
mod cases;
mod flight;

use base::*;
use cases::*;
use flight::*;
use opendr_control::online::AdaptationParams;
use opendr_engine::Result;
use opendr_engine::environment::Controller;
use opendr_engine::params::{Params as _, ParamValue};

struct Frozen(opendr_control::online::NeuralPolicy);
impl Controller for Frozen {
    fn act(&mut self, o: &[f32], a: &mut [f32]) -> Result<()> {
        opendr_control::online::AdaptablePolicy::act(&mut self.0, o, a)
    }
}

fn rms(f: &[Flight]) -> (f64, f64, f64, usize) {
    let n = f.len() as f64;
    let m = (f.iter().map(|f| f.last.powi(2)).sum::<f64>() / n).sqrt();
    let r = f.iter().map(|f| f.recovery).sum::<f64>() / n;
    let b = (f.iter().map(|f| f.before.powi(2)).sum::<f64>() / n).sqrt();
    (m, b, r, f.iter().filter(|f| f.lost).count())
}

fn main() -> Result<()> {
    let mut params = AdaptationParams::default();
    let mut n = 10;
    let mut plants = 0;
    for a in std::env::args().skip(1) {
        let (k, v) = a.split_once('=').unwrap();
        if k == "n" { n = v.parse().unwrap(); continue; }
        if k == "plants" { plants = v.parse().unwrap(); continue; }
        let value = match v.parse::<f64>() { Ok(x) => ParamValue::Float(x), Err(_) => match v.parse::<bool>() { Ok(b) => ParamValue::Bool(b), Err(_) => ParamValue::Text(v.to_owned()) } };
        params.set(k, value)?;
    }
    let t = std::time::Instant::now();
    let base = train(0)?;
    println!("imitation {:.3} m/s2 in {:.1} s", base.difference, t.elapsed().as_secs_f64());
    for (name, pairs) in CASES {
        let o = |_| options(pairs);
        let fr = rms(&fly_all(n, FIRST_SEED, o, || Ok(Frozen(base.policy.clone())))?);
        let pd = rms(&fly_all(n, FIRST_SEED, o, conventional)?);
        let pid = rms(&fly_all(n, FIRST_SEED, o, tuned_pid)?);
        let spid = rms(&fly_all(n, FIRST_SEED, o, strong_pid)?);
        let ad = rms(&fly_all(n, FIRST_SEED, o, || base.adapter(&params))?);
        println!("{name:20} pd {:.4} frozen {:.4} pid {:.4} spid {:.4} adapted {:.4} (before {:.4}) ratio frozen {:.3} pid {:.3} spid {:.3} rec {:.1} lost {} {} {}", pd.0, fr.0, pid.0, spid.0, ad.0, ad.1, ad.0 / fr.0, ad.0 / pid.0, ad.0/spid.0, ad.2, fr.3, pid.3, ad.3);
    }
    let mut flipped = params.clone();
    flipped.rate = -flipped.rate;
    // one adapter for events
    let mut ad = base.adapter(&params)?;
    let mut track = <opendr_simulation::quad_track::QuadTrack as opendr_simulation::Registered>::new(&Default::default())?;
    let mut e = Vec::new();
    for (name, pairs) in CASES {
        ad.restore_base();
        let t = std::time::Instant::now();
        let f = fly(&mut ad, &mut track, &options(pairs), 3, &mut e)?;
        println!("{name} {f:?} dist {} events {} steps {:?} {:.2} us/step", ad.distance(), ad.log().events().len(), ad.steps(), t.elapsed().as_secs_f64() * 1e6 / 6000.0);
        use opendr_control::online::EventKind::*;
        for k in [Snapshot, RolledBackToBase, RolledBackToSnapshot, Disarmed, Guarded, Frozen(opendr_control::online::FreezeReason::Saturated), Frozen(opendr_control::online::FreezeReason::Stale), Frozen(opendr_control::online::FreezeReason::OutsideEnvelope)] { print!("{k:?} {} ", ad.log().count(k)); }
        println!();
    }
    if plants > 0 {
        let fr = fly_all(plants, 2_000_000, random_plant, || Ok(Frozen(base.policy.clone())))?;
        let a = fly_all(plants, 2_000_000, random_plant, || base.adapter(&params))?;
        println!("plants frozen {:?} adapted {:?} worse {} worst ratio {:.2}", rms(&fr), rms(&a), fr.iter().zip(&a).filter(|(f, a)| a.last > f.last).count(), fr.iter().zip(&a).map(|(f, a)| a.last / f.last).fold(0.0, f64::max));
        println!("worst dist frozen {:.1} adapted {:.1}", fr.iter().map(|f| f.worst).fold(0.0, f64::max), a.iter().map(|f| f.worst).fold(0.0, f64::max));
    }
    Ok(())
}
