//! Active perception on a generated world, from nothing to a table:
//! `cargo run --release -p opendr-active --example sphere_view -- face [--seeds 5] [--timesteps 100000] [--episodes 500] [--strip OUT.png]`.

mod strip;

use std::time::Instant;

use opendr_active::sphere::{
    EmbeddingConfig, EmbeddingFit, SphereScene, SubjectPool, ViewSet, fit_embedding,
};
use opendr_active::{
    ActiveModel, ActiveReport, ActiveTraining, Greedy, Look, Mover, Oracle, Orbit, PolicyMover, RandomMover,
    Stare, StopRule, calibrated, run_episode, train_active,
};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;
use opendr_simulation::sphere_view::Subject;

/// First numbers of persons or instances: of the recogniser's training, of that of the swapped one, of the policy's, and of
/// those that no training saw.
const FIRST: [u32; 4] = [0, 10_000, 20_000, 30_000];
/// Pixels of a picture in each direction.
const PIXELS: usize = 32;
const EVALUATION: u64 = 1_000_000;

fn main() -> Result<()> {
    let options = Options::parse()?;
    let begun = Instant::now();
    let compute = Compute::with_threads(options.threads);
    let wide = EmbeddingConfig { epochs: options.epochs, ..EmbeddingConfig::default() };
    let other = EmbeddingConfig { hidden: 64, dimension: 12, seed: 9, ..wide.clone() };
    // Persons are recognised by who saw static pictures of them; objects and figures by who saw others of their classes.
    let faces = options.subject == Subject::Face;
    let scene = |persons: u32, instances: u32, config: &EmbeddingConfig| -> Result<SphereScene> {
        let fit = recogniser(&options, config, if faces { persons } else { instances }, &compute)?;
        SphereScene::new(&SubjectPool::generate(options.subject, persons, 6)?, &fit)
    };
    let known = scene(FIRST[2], FIRST[0], &wide)?;
    let strangers = scene(FIRST[3], FIRST[0], &wide)?;
    let exchanged = scene(FIRST[2], FIRST[1], &other)?;
    sectors("recogniser, others", &strangers)?;
    sectors("recogniser that is swapped in", &exchanged)?;
    if options.seeds == 0 {
        return Ok(());
    }
    println!("| training | views | accuracy (95 %) | ECE | median views to 0.9 | mean views |");
    println!("|---|---|---|---|---|---|");
    for seed in 0..options.seeds {
        let training = ActiveTraining {
            timesteps: options.timesteps,
            threads: options.threads,
            seed,
            ..ActiveTraining::default()
        };
        let part = Instant::now();
        let mut next = training.timesteps / 5;
        let model = train_active(&|| Ok(known.clone()), &training, &mut |steps, earned| {
            if steps >= next {
                eprintln!(
                    "  {steps} movements, mean return {earned:.3}, {:.0} s",
                    part.elapsed().as_secs_f64()
                );
                next += training.timesteps / 5;
            }
        })?;
        eprintln!("seed {seed}: {:?} after {:.0} s", model.fusion, part.elapsed().as_secs_f64());
        table(
            &format!("seed {seed}, persons or instances of the training"),
            &known,
            &model,
            options.episodes,
        )?;
        table(&format!("seed {seed}, others"), &strangers, &model, options.episodes)?;
        if let Some(path) = &options.strip {
            strip::write(&strangers, &model, EVALUATION, 6, path)?;
        }
        let model = calibrated(&model, &|| Ok(exchanged.clone()), 400)?;
        table(&format!("seed {seed}, another recogniser"), &exchanged, &model, options.episodes)?;
    }
    println!("\n{:.0} s in all", begun.elapsed().as_secs_f64());
    Ok(())
}

fn recogniser(
    options: &Options,
    config: &EmbeddingConfig,
    first: u32,
    compute: &Compute,
) -> Result<EmbeddingFit> {
    let begun = Instant::now();
    let views = ViewSet::render(options.subject, PIXELS, first, options.subjects, options.threads)?;
    let rendered = begun.elapsed().as_secs_f64();
    let fit = fit_embedding(&views, config, compute)?;
    eprintln!(
        "recogniser: {} views of {} classes in {rendered:.0} s, losses {:.2?} in {:.0} s",
        views.len(),
        views.classes,
        fit.losses,
        begun.elapsed().as_secs_f64() - rendered
    );
    Ok(fit)
}

/// Accuracy of single pictures by the angle from the front.
fn sectors(name: &str, scene: &SphereScene) -> Result<()> {
    let mut look = Look::new(scene.clone(), Default::default(), 1)?;
    let mut counts = [[0u32; 2]; 4];
    for episode in 0..1500 {
        look.begin(&mut Random::from_key([episode, 0x5ec]))?;
        let azimuth = look.scene().world().conditions().azimuth.abs().to_degrees();
        let [right, all] = &mut counts[[30.0, 60.0, 90.0].iter().filter(|edge| azimuth > **edge).count()];
        *right += u32::from(look.belief().best().0 == look.class());
        *all += 1;
    }
    let shares =
        counts.map(|[right, all]| format!("{:.0} %", 100.0 * f64::from(right) / f64::from(all.max(1))));
    eprintln!("{name}: right up to 30, 60, 90, 180 degrees from the front: {}", shares.join(", "));
    Ok(())
}

/// A row for each way to move.
fn table(name: &str, scene: &SphereScene, model: &ActiveModel, episodes: u64) -> Result<()> {
    let one = StopRule { moves: 0, ..model.stop };
    let movers: [(&str, Box<dyn Mover>, StopRule); 7] = [
        ("one picture (static)", Box::new(Stare), one),
        ("seven pictures from one place", Box::new(Stare), model.stop),
        ("random", Box::<RandomMover>::default(), model.stop),
        ("orbit", Box::new(Orbit), model.stop),
        ("greedy", Box::new(Greedy::new(model.gain.clone())), model.stop),
        ("policy", Box::new(PolicyMover::new(model.policy.clone())), model.stop),
        ("oracle", Box::new(Oracle), model.stop),
    ];
    let mut look = Look::new(scene.clone(), model.fusion, model.stop.moves)?;
    for (label, mut mover, stop) in movers {
        let seeds = EVALUATION..EVALUATION + episodes;
        let run = seeds.map(|seed| run_episode(&mut look, &mut *mover, &stop, seed, None));
        println!("| {name} | {label} | {} |", ActiveReport::of(&run.collect::<Result<Vec<_>>>()?)?);
    }
    Ok(())
}

struct Options {
    subject: Subject,
    seeds: u64,
    timesteps: u64,
    episodes: u64,
    subjects: usize,
    epochs: usize,
    threads: usize,
    strip: Option<String>,
}

impl Options {
    fn parse() -> Result<Self> {
        let mut options = Self {
            subject: Subject::Face,
            seeds: 1,
            timesteps: 50_000,
            episodes: 500,
            subjects: 1600,
            epochs: 8,
            threads: 2,
            strip: None,
        };
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            if let Some(subject) = Subject::ALL.into_iter().find(|subject| subject.name() == argument) {
                options.subject = subject;
                continue;
            }
            if argument == "--strip" {
                options.strip = arguments.next();
                continue;
            }
            let value = arguments.next().and_then(|value| value.parse().ok());
            let value: u64 =
                value.ok_or_else(|| Error::invalid_param(format!("give {argument} a number")))?;
            match argument.as_str() {
                "--seeds" => options.seeds = value,
                "--timesteps" => options.timesteps = value,
                "--episodes" => options.episodes = value,
                "--subjects" => options.subjects = value as usize,
                "--threads" => options.threads = value as usize,
                "--epochs" => options.epochs = value as usize,
                _ => {
                    return Err(Error::invalid_param(format!(
                        "no option {argument:?}; give face, object or pose, and --seeds, --timesteps, --episodes, --subjects or --epochs"
                    )));
                }
            }
        }
        Ok(options)
    }
}
