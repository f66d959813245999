//! A small environment with image observations.

use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::{Random, Result};
use opendr_simulation::vector::{Autoreset, EnvironmentVector, VecEnvironment};
use opendr_simulation::wrappers::TimeLimit;

/// A bright bar on the left or right of a 20x20 image; the correct action is -1 or 1. Each step has another image.
pub struct Dots {
    spec: EnvironmentSpec,
    random: Random,
    is_right: bool,
}

impl Dots {
    pub fn new() -> Self {
        let spec = EnvironmentSpec::new(
            "Dots-v0",
            Space::uniform(0.0, 255.0, &[SIDE, SIDE]).unwrap(),
            Space::symmetric(&[1.0]),
        );
        Self { spec, random: Random::new(0), is_right: false }
    }

    fn observe(&mut self, observation: &mut [f32]) {
        self.is_right = self.random.chance(0.5);
        let bar = if self.is_right { 14..17 } else { 3..6 };
        for (at, pixel) in observation.iter_mut().enumerate() {
            *pixel = if bar.contains(&(at % SIDE)) { 255.0 } else { 0.0 };
        }
    }
}

const SIDE: usize = 20;

impl Environment for Dots {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, _: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        if let Some(seed) = seed {
            self.random = Random::new(seed);
        }
        self.observe(observation);
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let wanted = if self.is_right { 1.0 } else { -1.0 };
        let reward = -f64::from((action[0] - wanted).abs());
        self.observe(observation);
        Ok(Step { reward, ..Step::default() })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.random.state().into_iter().for_each(|word| snapshot.push(word));
        snapshot.push(u64::from(self.is_right));
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.random = Random::from_state([state.word()?, state.word()?, state.word()?, state.word()?])?;
        self.is_right = state.flag()?;
        Ok(())
    }
}

/// Creates two of them, in episodes of five steps.
pub fn dots(threads: usize) -> Box<dyn VecEnvironment> {
    let world = || Box::new(TimeLimit::new(Dots::new(), 5).unwrap()) as Box<dyn Environment>;
    let both = vec![world(), world()];
    Box::new(EnvironmentVector::new(both, Autoreset::SameStep, threads).unwrap())
}
