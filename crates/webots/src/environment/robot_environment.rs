//! The environment.

use opendr_engine::data::Image;
use opendr_engine::environment::{Environment, EnvironmentSpec, Info, ResetOptions, Step};
use opendr_engine::{Error, Result};

use super::actuators::Actuators;
use super::options::{ID, WebotsParams};
use super::reward::Rewards;
use super::sensors::Sensors;
use crate::link::{StepEnd, WebotsLink};

/// A robot whose motors are the actions and whose sensors are the observations.
///
/// A reset resets the whole simulation, for which the robot must be a supervisor; the first reset of another robot takes the
/// simulation as it is. Webots' random numbers are not seeded by it. Each reset lets one step pass, after which all sensors have
/// measured.
pub struct WebotsEnvironment {
    link: Box<dyn WebotsLink>,
    spec: EnvironmentSpec,
    actuators: Actuators,
    sensors: Sensors,
    rewards: Option<Rewards>,
    step_ms: u32,
    is_used: bool,
}

impl WebotsEnvironment {
    /// Makes a connected robot an environment; address and version in `params` are not used.
    ///
    /// # Errors
    /// Returns `NotFound` for an unknown device, `InvalidParam` for one that does not fit, `Unsupported` for a robot without motors
    /// or sensors.
    pub fn new(link: Box<dyn WebotsLink>, params: &WebotsParams) -> Result<Self> {
        let robot = link.robot();
        let actuators = Actuators::select(robot, &params.motors)?;
        let sensors = Sensors::select(robot, &params.sensors)?;
        let rewards = Some(params.reward.as_str()).filter(|name| !name.is_empty());
        let rewards = rewards.map(|name| Rewards::select(robot, name)).transpose()?;
        let step_ms = match u32::try_from(params.step_ms) {
            Ok(step_ms) if step_ms > 0 => step_ms,
            _ => robot.basic_step_ms,
        };
        robot.check_step(step_ms)?;
        let spec = EnvironmentSpec::new(ID, sensors.space()?, actuators.space(robot)?);
        let spec = match u32::try_from(params.max_steps) {
            Ok(steps) if steps > 0 => spec.with_max_episode_steps(steps),
            _ => spec,
        };
        Ok(Self { link, spec, actuators, sensors, rewards, step_ms, is_used: false })
    }

    /// Returns the connection, for what is neither action nor observation.
    pub fn link(&mut self) -> &mut dyn WebotsLink {
        &mut *self.link
    }

    /// Lets a step pass.
    fn advance(&mut self) -> Result<()> {
        match self.link.step(self.step_ms)? {
            StepEnd::Running => Ok(()),
            StepEnd::Quit => Err(Error::network("Webots has ended the simulation")),
        }
    }
}

impl Environment for WebotsEnvironment {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, _: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        if let Some(name) = options.keys().next() {
            return Err(Error::invalid_param(format!("{ID} has no option {name:?} of a reset")));
        }
        let link = &mut *self.link;
        let period = u16::try_from(self.step_ms).unwrap_or(u16::MAX);
        self.actuators.stop(link)?;
        if link.robot().is_supervisor {
            link.supervisor()?.reset_simulation()?;
        } else if self.is_used {
            let error = link.robot().no_supervisor();
            return Err(error.context("the simulation can be reset only by a supervisor"));
        }
        self.sensors.enable(link, period)?;
        if let Some(rewards) = &self.rewards {
            rewards.enable(link, period)?;
        }
        self.is_used = true;
        self.advance()?;
        if let Some(rewards) = &mut self.rewards {
            rewards.clear(&mut *self.link)?;
        }
        self.sensors.observe(&*self.link, observation)?;
        Ok(Info::default().with("time", self.link.time()))
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.actuators.command(&mut *self.link, action)?;
        self.advance()?;
        self.sensors.observe(&*self.link, observation)?;
        let mut step = match &mut self.rewards {
            Some(rewards) => rewards.step(&mut *self.link)?,
            None => Step::default(),
        };
        step.info.set("time", self.link.time());
        Ok(step)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        let Some((camera, (width, height))) = self.sensors.camera() else { return Ok(None) };
        let image = self.link.image(camera)?;
        let pixels = image.as_chunks::<4>().0.iter().flat_map(|[blue, green, red, _]| [*red, *green, *blue]);
        Image::from_rgb8(pixels.collect(), width, height).map(Some)
    }
}
