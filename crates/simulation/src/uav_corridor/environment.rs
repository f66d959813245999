//! The corridor environment: steps, rewards, ends of episodes.

use std::collections::BTreeMap;

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Dtype, Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::Params as _;
use opendr_engine::{Random, Result};

use super::flight::Flight;
use super::range_camera::RangeCamera;
use super::{
    CorridorOptions, CorridorWorld, FINISH, HALF_TRACK, HEIGHT, SIDE, TARGET, UavDepthCorridorParams,
};
use crate::classic_control::{check_length, not_begun};
use crate::raycast::{Pose, Vector};
use crate::{NumpyRandom, RegisteredEnvironment};

/// `UavDepthCorridor-v1`: fly 30 m through obstacles, with a depth camera and the direction to a target 5 m ahead.
///
/// An action is heading and change of yaw, each +-22.5 degrees; the drone then flies one metre. The observation is a depth image of
/// 64 x 64 pixels up to 15 m, one byte per pixel as in OpenDR, and the target in metres: ahead, left, up. The reward of a step is
/// 2 |dx| - 0.4 |y| - 0.3 |yaw|, less 2 or 10 with an obstacle in a ball of radius 1.5 m or 1 m ahead; 20 for the finish, -10
/// off the track, -20 for a collision, which all terminate the episode. After 100 steps the episode is truncated. The info of each
/// step has `success` and `collision`, 0 or 1.
#[derive(Debug, Clone)]
pub struct UavDepthCorridor {
    spec: EnvironmentSpec,
    params: UavDepthCorridorParams,
    /// Options of this episode.
    options: CorridorOptions,
    place: Option<Place>,
    world: CorridorWorld,
    flight: Flight,
    camera: RangeCamera,
    path: Vec<Vector>,
}

/// Key of all random numbers of a step.
#[derive(Debug, Clone, Copy)]
struct Place {
    stream: u64,
    episode: u64,
    step: u64,
}

/// Uses of random numbers.
#[derive(Clone, Copy)]
enum Purpose {
    World,
    Wind,
    Camera,
}

/// OpenDR's discrete actions as heading and yaw.
const CHOICES: [[f32; 2]; 7] =
    [[1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [0.0, -1.0], [-1.0, 0.0], [-1.0, -1.0]];
/// Distance ahead and radius of the balls in which an obstacle reduces the reward, and by how much.
const SAFETY: [(f32, f32, f64); 2] = [(1.0, 1.5, 2.0), (0.5, 1.0, 10.0)];
const LIMIT: u32 = 100;

impl RegisteredEnvironment for UavDepthCorridor {
    const ID: &'static str = "UavDepthCorridor-v1";
    type Params = UavDepthCorridorParams;

    fn new(params: &UavDepthCorridorParams) -> Result<Self> {
        Self::called(Self::ID, params)
    }
}

impl UavDepthCorridor {
    /// Creates the environment with another id.
    pub(super) fn called(id: &str, params: &UavDepthCorridorParams) -> Result<Self> {
        let options = params.options.clone().checked()?;
        let action = match params.form.discrete {
            true => Space::discrete(CHOICES.len() as u32),
            false => Space::symmetric(&[1.0; 2]),
        };
        let worst = 0.4 * f64::from(HALF_TRACK) + 0.15 * std::f64::consts::PI + 12.0;
        let spec = EnvironmentSpec::new(id, observation_space(params)?, action)
            .with_max_episode_steps(LIMIT)
            .with_reward_range(-worst.max(20.0), 20.0);
        Ok(Self {
            spec,
            options,
            place: None,
            world: CorridorWorld::default(),
            flight: Flight::new([0.0; 3], None),
            camera: RangeCamera::new()?,
            path: Vec::new(),
            params: params.clone(),
        })
    }

    /// Returns the world of this episode.
    pub fn world(&self) -> &CorridorWorld {
        &self.world
    }

    /// Returns the position of the drone, in metres.
    pub fn position(&self) -> Vector {
        self.flight.position()
    }

    /// Returns the yaw of the drone, in radians to the left.
    pub fn yaw(&self) -> f64 {
        self.flight.yaw()
    }

    /// Returns the pose of the drone.
    pub fn pose(&self) -> Pose {
        self.flight.pose()
    }

    /// Returns the positions at the start and after each step of this episode.
    pub fn path(&self) -> &[Vector] {
        &self.path
    }

    fn random(&self, place: Place, purpose: Purpose) -> Random {
        Random::from_key([place.stream, place.episode, place.step, purpose as u64])
    }

    /// Generates the world of an episode and puts the drone at its start.
    fn begin(&mut self, place: Place) -> Result<()> {
        self.world.generate(&mut self.random(place, Purpose::World), &self.options)?;
        let wind = self.params.form.dynamics.then(|| {
            let mut random = self.random(place, Purpose::Wind);
            mean_wind(&mut random, f64::from(self.options.wind))
        });
        self.flight = Flight::new(self.world.start(), wind);
        self.path.clear();
        self.path.push(self.flight.position());
        Ok(())
    }

    fn action(&self, action: &[f32]) -> Result<[f32; 2]> {
        match (&self.spec.action, action) {
            (Space::Box { .. }, [heading, yaw]) if !heading.is_nan() && !yaw.is_nan() => {
                Ok([heading.clamp(-1.0, 1.0), yaw.clamp(-1.0, 1.0)])
            }
            (space, _) => {
                space.check(action)?;
                Ok(action
                    .first()
                    .and_then(|choice| CHOICES.get(*choice as usize))
                    .copied()
                    .unwrap_or_default())
            }
        }
    }

    fn observe(&mut self, place: Place, observation: &mut [f32]) -> Result<()> {
        check_length(&self.spec, observation)?;
        let (depths, rest) = observation.split_at_mut(SIDE * SIDE);
        let random = self.random(place, Purpose::Camera);
        self.camera.measure(self.world.scene(), &self.flight.pose(), &self.options, || random, depths);
        if !self.params.form.flat {
            for depth in depths {
                *depth = (*depth * 255.0).trunc();
            }
        }
        let [_, y, z] = self.flight.position();
        let (sine, cosine) = self.flight.heading();
        let target = [TARGET * cosine - y * sine, -TARGET * sine - y * cosine, HEIGHT - z];
        rest[..3].copy_from_slice(&target);
        if let [offset, yaw] = &mut rest[3..] {
            (*offset, *yaw) = (y, self.flight.yaw() as f32);
        }
        Ok(())
    }

    /// Returns reward and end of a step, from the position before it and whether it ended in a collision.
    fn evaluate_step(&self, from: Vector, collided: bool) -> Step {
        let [x, y, _] = self.flight.position();
        let finished = x > FINISH;
        let (reward, terminated) = match (finished, y.abs() > HALF_TRACK, collided) {
            (true, ..) => (20.0, true),
            (_, true, _) => (-10.0, true),
            (.., true) => (-20.0, true),
            _ => (self.reward(from), false),
        };
        let success = finished && !collided;
        let info = Info::default()
            .with("success", f64::from(u8::from(success)))
            .with("collision", f64::from(u8::from(collided)));
        Step { reward, terminated, truncated: false, info }
    }

    fn reward(&self, from: Vector) -> f64 {
        let [x, y, z] = self.flight.position();
        let (sine, cosine) = self.flight.heading();
        let advance = f64::from((x - from[0]).abs());
        let cost = |(ahead, radius, cost): (f32, f32, f64)| {
            let centre = [x + ahead * cosine, y + ahead * sine, z];
            if self.world.is_occupied(centre, radius) { cost } else { 0.0 }
        };
        let unsafety: f64 = SAFETY.into_iter().map(cost).sum();
        2.0 * advance - 0.4 * f64::from(y.abs()) - 0.3 * self.flight.yaw().abs() - unsafety
    }
}

/// Returns the space of depth, target and, if enabled, pose.
fn observation_space(params: &UavDepthCorridorParams) -> Result<Space> {
    let right_angle = std::f32::consts::FRAC_PI_2;
    let pose = [f32::INFINITY, if params.form.dynamics { 2.0 * right_angle } else { right_angle }];
    if params.form.flat {
        let numbers = SIDE * SIDE;
        let unbounded = if params.form.pose { 5 } else { 3 };
        let low = [vec![0.0; numbers], vec![f32::NEG_INFINITY; unbounded]].concat();
        let high = [vec![1.0; numbers], vec![f32::INFINITY; unbounded]].concat();
        return Space::bounded(low, high, vec![numbers + unbounded]);
    }
    let mut parts = BTreeMap::from([
        ("depth_cam".to_owned(), Space::uniform(0.0, 255.0, &[SIDE, SIDE, 1])?.with_dtype(Dtype::Uint8)?),
        ("moving_target".to_owned(), Space::symmetric(&[f32::INFINITY; 3]).with_dtype(Dtype::Float64)?),
    ]);
    if params.form.pose {
        parts.insert("pose".to_owned(), Space::symmetric(&pose));
    }
    Ok(Space::Dict(parts))
}

/// Returns a random horizontal wind of at most `most` m/s.
fn mean_wind(random: &mut Random, most: f64) -> [f64; 3] {
    loop {
        let [x, y] = [(); 2].map(|()| 2.0 * random.unit() - 1.0);
        let size = (x * x + y * y).sqrt();
        if size > 1e-3 && size < 1.0 {
            let speed = most * random.unit() / size;
            return [speed * x, speed * y, 0.0];
        }
    }
}

impl Environment for UavDepthCorridor {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let mut chosen = self.params.options.clone();
        options.iter().try_for_each(|(name, value)| chosen.set(name, value.clone()))?;
        self.options = chosen.checked()?;
        let place = match (seed, self.place) {
            (None, Some(place)) => Place { episode: place.episode.wrapping_add(1), step: 0, ..place },
            (seed, _) => {
                let stream = seed.unwrap_or_else(|| NumpyRandom::from_entropy().bits());
                Place { stream, episode: 0, step: 0 }
            }
        };
        self.place = Some(place);
        self.begin(place)?;
        self.observe(place, observation)?;
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let action = self.action(action)?;
        let place = self.place.ok_or_else(|| not_begun(&self.spec))?;
        let place = Place { step: place.step.wrapping_add(1), ..place };
        self.place = Some(place);
        let from = self.flight.position();
        let mut random = self.random(place, Purpose::Wind);
        let collided = self.flight.advance(action, self.world.scene(), &mut random);
        self.path.push(self.flight.position());
        self.observe(place, observation)?;
        Ok(self.evaluate_step(from, collided))
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let place = self.place.ok_or_else(|| not_begun(&self.spec))?;
        [place.stream, place.episode, place.step].into_iter().for_each(|word| snapshot.push(word));
        snapshot.extend_numbers(self.options.numbers());
        self.flight.save(snapshot);
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let [stream, episode, step] = [state.word()?, state.word()?, state.word()?];
        self.options = CorridorOptions::of_numbers(crate::multirotor::numbers(state)?)?;
        self.begin(Place { stream, episode, step: 0 })?;
        self.flight.load(state)?;
        self.place = Some(Place { stream, episode, step });
        self.path = vec![self.flight.position()];
        Ok(())
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.place.ok_or_else(|| not_begun(&self.spec))?;
        super::picture::picture(self.world.scene(), self.pose(), &self.path).map(Some)
    }
}
