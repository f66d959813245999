use opendr_active::*;
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::params::ParamMap;
use opendr_engine::rig::ViewPose;
use opendr_engine::{Random, Result};
use opendr_kernels::Compute;
use opendr_simulation::RegisteredSource;
use std::time::Instant;

fn arg<T: std::str::FromStr>(name: &str, default: T) -> T {
    let all: Vec<String> = std::env::args().collect();
    all.iter().position(|a| a == name).and_then(|at| all[at + 1].parse().ok()).unwrap_or(default)
}

fn main() -> Result<()> {
    let id = format!("SphereView-{}-v1", arg("--world", "Object".to_owned()));
    let source = RegisteredSource::new(&id, &ParamMap::from_iter([("gallery".to_owned(), 0.into())]))?;
    let episodes: u64 = arg("--episodes", 12000);
    let epochs: usize = arg("--epochs", 8);
    let k: usize = arg("--kernels", 16);
    let fresh: u8 = arg("--fresh", 1);
    let begun = Instant::now();
    let rigs = (0..2).map(|_| EnvironmentRig::new(source.make()?)).collect::<Result<Vec<_>>>()?;
    let config = ViewClassifierConfig {
        side: 0,
        kernels: vec![k, 2 * k, 3 * k],
        hidden: arg("--hidden", 128),
        dimension: 24,
        classes: 0,
    };
    let training = ViewTraining { config, epochs, seed: 0 };
    let compute = Compute::with_threads(2);
    let mut source_views: Box<dyn ViewSource> = if fresh == 1 {
        Box::new(FreshViews::new(rigs, 1 << 40, episodes))
    } else {
        let mut rigs = rigs;
        Box::new(LabelledViews::collect(&mut rigs, 1 << 40, episodes)?)
    };
    eprintln!("collected {:.0} s", begun.elapsed().as_secs_f64());
    let (recogniser, best) = fit_view_networks(&mut *source_views, &training, &compute, &mut |e, l, b| {
        eprintln!("epoch {e} loss {l:.3} best {b:.3?} {:.0} s", begun.elapsed().as_secs_f64());
        false
    })?;
    let mut best = best.unwrap();
    // Held-out views.
    let mut scene = EnvironmentScene::new(&source, recogniser)?;
    let stop = StopRule { confidence: 1.0, moves: 6, gain: 0.0 };
    let classes = scene.classes();
    for (name, first) in [("oracle", 0), ("seek", 1)] {
        let mut errors: Vec<Vec<f64>> = vec![vec![]; 7];
        let mut run = |first: u64,
                       n: u64,
                       fusion: Fusion|
         -> Result<(Vec<Trajectory>, usize, Vec<usize>, f64, [[u32; 2]; 10])> {
            let (mut out, mut right, mut views, mut nll) = (vec![], 0, vec![], 0.0);
            let mut bins = [[0u32; 2]; 10];
            for seed in first..first + n {
                let class = scene.begin(&mut Random::from_key([seed, 7]))?;
                let mut evidence = vec![0.0; scene.classes()];
                let mut seek = BestViewBelief::default();
                let mut belief = Belief::new(scene.classes(), fusion)?;
                let mut t = Trajectory { class, poses: vec![], evidence: vec![] };
                let mut reached = 0;
                for view in 0..7 {
                    let image = scene.view(&mut evidence)?.clone();
                    let pose = scene.rig().pose();
                    seek.add(pose, &best.estimate(&image)?);
                    belief.add(pose, &evidence)?;
                    nll -= f64::from(evidence[class]) / 7.0;
                    t.poses.push(pose);
                    t.evidence.extend(&evidence);
                    if belief.best().1 >= 0.9 && reached == 0 {
                        reached = view + 1;
                    }
                    let target = seek.best();
                    let truth = scene.best_pose().unwrap();
                    let to = {
                        let [x, y, z] = target.direction.map(f64::from);
                        ViewPose { azimuth: y.atan2(x), elevation: z.asin(), distance: 2.7, fourth: 0.0 }
                    };
                    errors[view].push(truth.angle_to(&to).to_degrees());
                    let goal = if name == "oracle" { truth } else { to };
                    if view == 6 || belief.best().1 > 0.97 {
                        break;
                    }
                    let axes = scene.rig().axes().to_vec();
                    let mut action = [0.0f32; 3];
                    let context = CameraContext { observation: &[], pose, axes: &axes, best: Some(goal) };
                    OracleBaseline.choose(&context, &mut action)?;
                    scene.rig().apply(&opendr_engine::target::Action::new(&action)?)?;
                }
                right += usize::from(belief.best().0 == class);
                let c = belief.best().1;
                let b = ((c * 10.0) as usize).min(9);
                bins[b][0] += 1;
                bins[b][1] += u32::from(belief.best().0 == class);
                views.push(if reached == 0 { 99 } else { reached });
                out.push(t);
            }
            views.sort();
            Ok((out, right, views, nll / n as f64, bins))
        };
        let (trajectories, ..) = run(10_000, 600, Fusion::default())?;
        let fusion = fit_fusion(classes, &trajectories)?;
        for view in 0..7 {
            let of: Vec<(&[f32], usize)> = trajectories
                .iter()
                .filter_map(|t| t.evidence.chunks_exact(classes).nth(view).map(|e| (e, t.class)))
                .collect();
            let nll = |f: f32| {
                of.iter()
                    .map(|(e, c)| {
                        let s: f32 = e.iter().map(|l| (l * f).exp()).sum();
                        f64::from(s.ln() - f * e[*c])
                    })
                    .sum::<f64>()
                    / of.len() as f64
            };
            let right = of.iter().filter(|(e, c)| e.iter().all(|l| *l <= e[*c])).count();
            let conf: f32 =
                of.iter().map(|(e, _)| e.iter().copied().fold(-99.0, f32::max).exp()).sum::<f32>()
                    / of.len() as f32;
            println!(
                "  view {view}: {} accuracy {:.3} confidence {conf:.3}, nll at 1/T 0.25 .5 .75 1 1.25 1.5 2: {:.3?}",
                of.len(),
                right as f64 / of.len() as f64,
                [0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0].map(nll)
            );
        }
        for f in [
            fusion,
            Fusion { temperature: 1.0, length: 0.3, floor: 0.1 },
            Fusion { temperature: 1.0, length: 0.6, floor: 0.45 },
            Fusion { temperature: 1.0, length: 0.6, floor: 0.75 },
            Fusion { temperature: 1.0, length: 0.6, floor: 1.0 },
        ] {
            let mut nll = [[0.0f64; 2]; 7];
            for t in &trajectories {
                let mut belief = Belief::new(classes, f)?;
                for (view, (pose, e)) in t.poses.iter().zip(t.evidence.chunks_exact(classes)).enumerate() {
                    belief.add(*pose, e)?;
                    nll[view][0] -= f64::from(belief.probabilities()[t.class].max(1e-9).ln());
                    nll[view][1] += 1.0;
                }
            }
            println!("  {f:?} fused nll {:.3?}", nll.map(|[s, n]| s / n));
        }
        let n = 500;
        let (_, right, views, nll, bins) = run(20_000, n, fusion)?;
        println!(
            "{name} {first}: {fusion:?} accuracy {:.1} median views {} nll {nll:.3} {bins:?}",
            100.0 * right as f64 / n as f64,
            views[views.len() / 2]
        );
        for e in &mut errors {
            e.sort_by(f64::total_cmp);
        }
        println!(
            "median errors of the direction {:.1?}, 90 % {:.1?}",
            errors.iter().map(|e| e.get(e.len() / 2).copied().unwrap_or(0.0)).collect::<Vec<_>>(),
            errors.iter().map(|e| e.get(e.len() * 9 / 10).copied().unwrap_or(0.0)).collect::<Vec<_>>()
        );
    }
    println!("{:.0} s", begun.elapsed().as_secs_f64());
    Ok(())
}
