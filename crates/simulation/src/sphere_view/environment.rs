//! The environments: view, move, classify.

use std::collections::BTreeMap;

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Dtype, Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::rig::{ViewRig as _, ViewSphere};
use opendr_engine::target::Action;
use opendr_engine::{Random, Result};

use super::subject::PERSONS;
use super::{Asset, Conditions, SIDE, SphereWorld, Subject};
use crate::classic_control::{check_length, not_begun};
use crate::registration::checked;
use crate::{NumpyRandom, Registration};

/// Maximum number of motions of an episode.
pub const MOVES: u32 = 6;
/// Number of axes of a motion.
const AXES: usize = 3;
/// Maximum score of a class.
const LIMIT: f32 = 20.0;
/// Cost of a motion of full deflection on all axes.
const COST: f64 = 0.02;

/// Parameters of the `SphereView` environments.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct SphereViewParams {
    /// The persons, or the instances of each class, that episodes choose from: twenty persons, a hundred instances.
    #[param(default = 0, range = 0..=1_000_000)]
    pub gallery: u32,
}

/// `SphereView-Face-v1`, `SphereView-Object-v1`, `SphereView-Pose-v1`: classify a subject from up to seven views.
///
/// An action is a motion of three axes, each in [-1, 1] (azimuth by 35 degrees, elevation by 17, distance by 0.7 radii), and
/// then a score for each class. An observation is an `image` of 48 x 48 pixels and a `pose`: azimuth relative to the first
/// pose (rad), elevation (rad), distance (radii), number of motions. The reward of a step is the rise of the probability of
/// the true class, under the softmax of the scores (from 1 over the number of classes), minus 0.02 times the mean square of
/// the motion. The seventh step does not move; it ends the episode. The info of a step has `success`, whether the highest
/// score is that of the true class. The info of a reset has what only a simulator knows, for training and evaluation: `class`,
/// `best_azimuth` and `best_elevation`.
#[derive(Debug, Clone)]
pub struct SphereView {
    spec: EnvironmentSpec,
    subject: Subject,
    params: SphereViewParams,
    world: SphereWorld,
    episode: Option<Episode>,
    pixels: Vec<u8>,
}

#[derive(Debug, Clone)]
struct Episode {
    /// The seed, and the number of the episode since.
    place: [u64; 2],
    class: u32,
    moves: u32,
    /// The probability that the true class was given.
    probability: f64,
    /// All movements so far: with the place, what leads back here.
    actions: Vec<f32>,
}

impl SphereView {
    /// Creates the environment of a subject.
    ///
    /// # Errors
    /// None for any gallery in range.
    pub fn new(subject: Subject, params: &SphereViewParams) -> Result<Self> {
        params.check()?;
        let classes = subject.classes() as usize;
        let limits: Vec<f32> = [1.0; AXES].into_iter().chain(vec![LIMIT; classes]).collect();
        let bounds = ViewSphere::camera(Default::default())?;
        let low: Vec<_> = bounds.axes().iter().map(|axis| axis.low as f32).chain([0.0]).collect();
        let high: Vec<_> = bounds.axes().iter().map(|axis| axis.high as f32).chain([MOVES as f32]).collect();
        let observation = Space::Dict(BTreeMap::from([
            ("image".to_owned(), Space::uniform(0.0, 255.0, &[SIDE, SIDE, 3])?.with_dtype(Dtype::Uint8)?),
            ("pose".to_owned(), Space::bounded(low, high, vec![AXES + 1])?),
        ]));
        let spec = EnvironmentSpec::new(subject.id(), observation, Space::symmetric(&limits))
            .with_max_episode_steps(MOVES + 1)
            .with_reward_range(-1.0 - COST, 1.0);
        let world = SphereWorld::new(SIDE)?;
        let pixels = vec![0; 3 * SIDE * SIDE];
        Ok(Self { spec, subject, params: params.clone(), world, episode: None, pixels })
    }

    /// Returns the camera and its subject.
    pub fn world(&self) -> &SphereWorld {
        &self.world
    }

    fn begin(&mut self, place: [u64; 2]) -> Result<Info> {
        let mut random = Random::from_key([place[0], place[1], self.subject as u64]);
        let class = random.below(self.subject.classes() as usize) as u32;
        let gallery = u64::from(self.params.gallery);
        let (generated, instance) = match self.subject {
            Subject::Face => (self.params.gallery * PERSONS + class, 0),
            Subject::Object | Subject::Pose => (class, 100 * gallery + random.below(100) as u64),
        };
        let asset = Asset::generate(self.subject, generated, instance)?;
        let conditions = Conditions::draw(&mut random);
        self.world.begin(&asset, &conditions, random.bits())?;
        let probability = 1.0 / f64::from(self.subject.classes());
        self.episode = Some(Episode {
            place,
            class,
            moves: 0,
            probability,
            actions: Vec::with_capacity(AXES * MOVES as usize),
        });
        Ok(conditions.info(class))
    }

    fn observe(&mut self, observation: &mut [f32]) -> Result<()> {
        check_length(&self.spec, observation)?;
        self.world.capture_into(&mut self.pixels);
        let (image, numbers) = observation.split_at_mut(self.pixels.len());
        image.iter_mut().zip(&self.pixels).for_each(|(to, level)| *to = f32::from(*level));
        let pose = self.world.pose();
        let moves = self.episode.as_ref().map_or(0, |episode| episode.moves);
        let shown = [pose.azimuth, pose.elevation, pose.distance].map(|part| part as f32);
        numbers[..AXES].copy_from_slice(&shown);
        numbers[AXES] = moves as f32;
        Ok(())
    }
}

/// The probability of a class under the softmax of scores, and whether its score is the highest.
fn judged(scores: &[f32], class: usize) -> (f64, bool) {
    let highest = scores.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let sum: f64 = scores.iter().map(|score| f64::from(score - highest).exp()).sum();
    let others = scores.iter().enumerate().filter(|(at, _)| *at != class);
    let first = others.map(|(_, score)| *score).fold(f32::NEG_INFINITY, f32::max);
    (f64::from(scores[class] - highest).exp() / sum, scores[class] > first)
}

impl Environment for SphereView {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        check_length(&self.spec, observation)?;
        let mut params = self.params.clone();
        options.iter().try_for_each(|(name, value)| params.set(name, value.clone()))?;
        params.check()?;
        self.params = params;
        let place = match (seed, &self.episode) {
            (None, Some(Episode { place: [seed, number], .. })) => [*seed, number.wrapping_add(1)],
            (seed, _) => [seed.unwrap_or_else(|| NumpyRandom::from_entropy().bits()), 0],
        };
        let info = self.begin(place)?;
        self.observe(observation)?;
        Ok(info)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.spec.action.check(action)?;
        let episode = self.episode.as_mut().ok_or_else(|| not_begun(&self.spec))?;
        let (movement, scores) = action.split_at(AXES);
        let (probability, is_right) = judged(scores, episode.class as usize);
        let terminated = episode.moves == MOVES;
        let mut reward = probability - episode.probability;
        episode.probability = probability;
        if !terminated {
            let achieved = self.world.apply(&Action::new(movement)?)?;
            reward -= COST * f64::from(achieved.effort());
            episode.moves += 1;
            episode.actions.extend_from_slice(movement);
        }
        self.observe(observation)?;
        let info = Info::default().with("success", f64::from(u8::from(is_right)));
        Ok(Step { reward, terminated, truncated: false, info })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        episode.place.iter().for_each(|word| snapshot.push(*word));
        snapshot.push(u64::from(self.params.gallery));
        snapshot.push_number(episode.probability);
        snapshot.push(episode.actions.len() as u64);
        snapshot.extend_numbers(episode.actions.iter().map(|part| f64::from(*part)));
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let place = [state.word()?, state.word()?];
        self.params.gallery = state.count(1_000_000)? as u32;
        let probability = state.finite()?;
        let count = state.count(AXES * MOVES as usize)?;
        let actions = (0..count).map(|_| state.finite().map(|part| part as f32));
        let actions = actions.collect::<Result<Vec<_>>>()?;
        self.begin(place)?;
        // Images are captured as before, so that the noise continues from the same state.
        self.world.capture_into(&mut self.pixels);
        for movement in actions.chunks(AXES) {
            self.world.apply(&Action::new(movement)?)?;
            self.world.capture_into(&mut self.pixels);
        }
        if let Some(episode) = &mut self.episode {
            episode.moves = (count / AXES) as u32;
            (episode.probability, episode.actions) = (probability, actions);
        }
        Ok(())
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        Image::from_rgb8(self.pixels.clone(), SIDE, SIDE).map(Some)
    }
}

/// The environments of all subjects.
pub(crate) fn registrations() -> [Registration; 3] {
    Subject::ALL.map(|subject| {
        let make = move |params: &ParamMap| -> Result<_> {
            checked(SphereView::new(subject, &SphereViewParams::from_map(params)?)?)
        };
        Registration::new(subject.id(), SphereViewParams::FIELDS, make)
    })
}
