//! The environment: images, attempts, ends of episodes.

use std::collections::BTreeMap;

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Dtype, Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Random, Result};

use super::attempt::{Outcome, attempt};
use super::camera::Camera;
use super::demonstration::{colour_image, depth_image};
use super::scene::{Surroundings, render};
use super::{ATTEMPTS, Grasp, GraspObject, HALF_VIEW, PlanarGraspParams};
use crate::RegisteredEnvironment;
use crate::classic_control::{check_length, not_begun};
use crate::drawing::Drawing;
use crate::multirotor::numbers;
use crate::planar::{EpisodeKey, Pose};
use crate::solids::Solid;

/// `PlanarGrasp-v1`: grasp an object from above, as a camera sees it.
///
/// An action has four numbers in [-1, 1]: place of the grasp over 15 cm along x and y, the direction in which the jaws close over a
/// right angle, and the width before they close from 0 to 9 cm. A step is one attempt. The observation has the depth image in metres
/// and the colour image of one byte per level. The episode terminates with the object held, at a reward of 1, or pushed out of view;
/// after 20 attempts it is truncated. The info of each step has `success`, 0 or 1, and `distance`, m, and `angle`, rad, of the attempt
/// from the grasp that is demonstrated for the object.
#[derive(Debug, Clone)]
pub struct PlanarGrasp {
    spec: EnvironmentSpec,
    params: PlanarGraspParams,
    episode: Option<Episode>,
    colours: Vec<f32>,
    depths: Vec<f32>,
}

#[derive(Debug, Clone)]
struct Episode {
    params: PlanarGraspParams,
    key: EpisodeKey,
    attempts: u64,
    object: GraspObject,
    pose: Pose,
    surroundings: Surroundings,
    last: Option<Grasp>,
}

impl RegisteredEnvironment for PlanarGrasp {
    const ID: &'static str = "PlanarGrasp-v1";
    type Params = PlanarGraspParams;

    fn new(params: &PlanarGraspParams) -> Result<Self> {
        params.check()?;
        let size = params.size;
        let parts = BTreeMap::from([
            ("depth".to_owned(), Space::uniform(0.0, 2.0, &[size, size, 1])?),
            ("image".to_owned(), Space::uniform(0.0, 255.0, &[size, size, 3])?.with_dtype(Dtype::Uint8)?),
        ]);
        let spec = EnvironmentSpec::new(Self::ID, Space::Dict(parts), Space::symmetric(&[1.0; 4]))
            .with_max_episode_steps(ATTEMPTS)
            .with_reward_range(0.0, 1.0);
        let (colours, depths) = (vec![0.0; 3 * size * size], vec![0.0; size * size]);
        Ok(Self { spec, params: params.clone(), episode: None, colours, depths })
    }
}

impl Episode {
    fn begin(params: PlanarGraspParams, key: EpisodeKey) -> Self {
        let mut random = key.random();
        let drawn = GraspObject::ALL[random.below(GraspObject::ALL.len())];
        let mut spread = || params.spread * (2.0 * random.unit() - 1.0);
        let place = [spread(), spread()];
        let pose = Pose::new(place, std::f64::consts::TAU * random.unit());
        let surroundings = Surroundings::draw(params.variation, &mut random);
        let object = params.object.unwrap_or(drawn);
        Self { params, key, attempts: 0, object, pose, surroundings, last: None }
    }

    fn random(&self) -> Random {
        let mut random = self.key.random();
        Random::from_key([random.bits(), self.attempts])
    }
}

impl PlanarGrasp {
    /// Returns the camera.
    pub fn camera(&self) -> Camera {
        Camera::new(self.params.size)
    }

    /// Returns the present colour image.
    ///
    /// # Errors
    /// `InvalidInput` before the first reset.
    pub fn image(&self) -> Result<Image> {
        self.begun()?;
        colour_image(&self.colours, self.params.size)
    }

    /// Returns the present depth image of floats in metres, as GR-ConvNet takes it.
    ///
    /// # Errors
    /// `InvalidInput` before the first reset.
    pub fn depth(&self) -> Result<Image> {
        self.begun()?;
        depth_image(&self.depths, self.params.size)
    }

    /// Returns the object on the table.
    ///
    /// # Errors
    /// `InvalidInput` before the first reset.
    pub fn object(&self) -> Result<GraspObject> {
        Ok(self.begun()?.object)
    }

    /// Returns the grasp of the object where it lies that corresponds to the demonstrated one.
    ///
    /// # Errors
    /// `InvalidInput` before the first reset.
    pub fn shown_grasp(&self) -> Result<Grasp> {
        let episode = self.begun()?;
        Ok(episode.object.shown_grasp(&episode.pose))
    }

    /// Returns the object as a solid of [`GRASP_HEIGHT`](super::GRASP_HEIGHT).
    ///
    /// # Errors
    /// `InvalidInput` before the first reset.
    pub fn solid(&self) -> Result<Solid> {
        let episode = self.begun()?;
        let mut body = episode.object.body(episode.params.friction);
        body.pose = episode.pose;
        Ok(Solid::of(&body))
    }

    /// Returns what comes of a grasp, without moving the object.
    ///
    /// # Errors
    /// `InvalidInput` before the first reset, and for a grasp that is not finite.
    pub fn test_grasp(&self, grasp: &Grasp) -> Result<Outcome> {
        let episode = self.begun()?;
        if ![grasp.place[0], grasp.place[1], grasp.angle, grasp.width].iter().all(|part| part.is_finite()) {
            return Err(Error::invalid_input(format!("{grasp:?}: give finite numbers")));
        }
        Ok(attempt(&episode.params, episode.object, grasp, &mut episode.pose.clone()))
    }

    fn begun(&self) -> Result<&Episode> {
        self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))
    }

    /// Renders the present view.
    fn look(&mut self) {
        let Some(episode) = &self.episode else { return };
        let view = (episode.object, episode.pose);
        let images = (&mut self.colours[..], &mut self.depths[..]);
        render(&episode.params, &episode.surroundings, view, &mut episode.random(), images);
    }

    /// Renders the present view and writes it.
    fn see(&mut self, observation: &mut [f32]) {
        self.look();
        let (depths, colours) = observation.split_at_mut(self.depths.len());
        depths.copy_from_slice(&self.depths);
        colours.copy_from_slice(&self.colours);
    }
}

impl Environment for PlanarGrasp {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        check_length(&self.spec, observation)?;
        let mut chosen = self.params.clone();
        options.iter().try_for_each(|(name, value)| chosen.set(name, value.clone()))?;
        chosen.check()?;
        if chosen.size != self.params.size {
            return Err(Error::invalid_param(
                "the size is part of the spec; set it where the environment is made",
            ));
        }
        let key = EpisodeKey::after_reset(seed, self.episode.as_ref().map(|episode| episode.key));
        self.episode = Some(Episode::begin(chosen, key));
        self.see(observation);
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        check_length(&self.spec, observation)?;
        self.spec.action.check(action)?;
        let episode = self.episode.as_mut().ok_or_else(|| not_begun(&self.spec))?;
        let grasp = Grasp::of_action(std::array::from_fn(|at| action.get(at).copied().unwrap_or_default()));
        let (distance, angle) = grasp.difference(&episode.object.shown_grasp(&episode.pose));
        let outcome = attempt(&episode.params, episode.object, &grasp, &mut episode.pose);
        (episode.last, episode.attempts) = (Some(grasp), episode.attempts + 1);
        let held = outcome == Outcome::Held;
        let lost = episode.pose.place.iter().any(|part| part.abs() > HALF_VIEW);
        self.see(observation);
        let success = f64::from(u8::from(held));
        let info = Info::default().with("success", success).with("distance", distance).with("angle", angle);
        Ok(Step { reward: success, terminated: held || lost, truncated: false, info })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let episode = self.begun()?;
        episode.key.save(snapshot);
        snapshot.push(episode.attempts);
        snapshot.extend_numbers(episode.params.numbers());
        snapshot.extend_numbers(episode.pose.place.into_iter().chain([episode.pose.angle]));
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let (key, attempts) = (EpisodeKey::load(state)?, state.word()?);
        let params = PlanarGraspParams::of_numbers(numbers(state)?);
        params.check()?;
        if params.size != self.params.size {
            return Err(Error::format(format!(
                "the snapshot has images of {} pixels, the environment of {}; make it with the size of the snapshot",
                params.size, self.params.size
            )));
        }
        let mut episode = Episode::begin(params, key);
        let [x, y, angle] = numbers(state)?;
        (episode.pose, episode.attempts) = (Pose::new([x, y], angle), attempts);
        self.episode = Some(episode);
        self.look();
        Ok(())
    }

    fn render(&mut self) -> Result<Option<Image>> {
        let last = self.begun()?.last;
        let camera = Camera::new(SHOWN);
        let image = opendr_vision::resize(&self.image()?, SHOWN, SHOWN)?;
        let mut drawing = Drawing::over(image);
        if let Some(grasp) = last {
            let [left, right] = camera.jaws(&grasp).map(|[column, row]| [column, SHOWN as f32 - row]);
            drawing.line(left, right, 2.0, [220, 40, 40]);
            [left, right].into_iter().for_each(|jaw| drawing.disc(jaw, 6.0, [220, 40, 40]));
        }
        Ok(Some(drawing.finish()))
    }
}

/// Side of the images of [`Environment::render`], pixels.
const SHOWN: usize = 384;
