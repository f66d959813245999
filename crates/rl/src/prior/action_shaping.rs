//! Policies that command a controller.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::{Error, Result};

/// A controller that follows commands: references, such as a speed to hold, or gains.
pub trait CommandedController: Send {
    /// The space of commands: the action space of the policy. The command of zeros, where it has one, is best the controller without
    /// commands: a policy that commands zeros then begins as its prior.
    fn commands(&self) -> &Space;

    /// Number of numbers of an action.
    fn actions(&self) -> usize;

    /// Forgets the episode; called when another begins.
    fn reset(&mut self) {}

    /// Writes the action that follows `command` for an observation.
    ///
    /// # Errors
    /// `InvalidInput` for an observation of another space.
    fn follow(&mut self, observation: &[f32], command: &[f32], action: &mut [f32]) -> Result<()>;

    /// Writes the state that the next actions depend on; the default is for controllers without one.
    ///
    /// # Errors
    /// `Unsupported` for a controller that has a state and cannot write it.
    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let _ = snapshot;
        Ok(())
    }

    /// Reads what [`save_state`](Self::save_state) wrote.
    ///
    /// # Errors
    /// As there, and `Format` for the state of something else.
    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let _ = state;
        Ok(())
    }
}

/// A commanded controller that can move between threads.
pub type BoxedCommanded = Box<dyn CommandedController>;

impl CommandedController for BoxedCommanded {
    fn commands(&self) -> &Space {
        (**self).commands()
    }

    fn actions(&self) -> usize {
        (**self).actions()
    }

    fn reset(&mut self) {
        (**self).reset();
    }

    fn follow(&mut self, observation: &[f32], command: &[f32], action: &mut [f32]) -> Result<()> {
        (**self).follow(observation, command, action)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        (**self).save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        (**self).load_state(state)
    }
}

/// A [`CommandedController`] of a function without state.
pub struct CommandLaw<F> {
    commands: Space,
    actions: usize,
    law: F,
}

impl<F: Fn(&[f32], &[f32], &mut [f32]) -> Result<()> + Send> CommandLaw<F> {
    /// Creates a controller from `law`, which writes an action of `actions` numbers from observation and command.
    pub fn new(commands: Space, actions: usize, law: F) -> Self {
        Self { commands, actions, law }
    }
}

impl<F: Fn(&[f32], &[f32], &mut [f32]) -> Result<()> + Send> CommandedController for CommandLaw<F> {
    fn commands(&self) -> &Space {
        &self.commands
    }

    fn actions(&self) -> usize {
        self.actions
    }

    fn follow(&mut self, observation: &[f32], command: &[f32], action: &mut [f32]) -> Result<()> {
        (self.law)(observation, command, action)
    }
}

/// An environment whose actions are commands that a controller follows, for `hold` steps each.
pub struct Commanded<E, C> {
    inner: E,
    controller: C,
    hold: u32,
    spec: EnvironmentSpec,
    seen: Vec<f32>,
    action: Vec<f32>,
}

impl<E: Environment, C: CommandedController> Commanded<E, C> {
    /// Wraps `inner` so that `controller` follows each command for `hold` steps; their rewards are summed.
    ///
    /// # Errors
    /// `InvalidParam` where `hold` is 0, `InvalidInput` for a controller with actions of another length.
    pub fn new(inner: E, controller: C, hold: u32) -> Result<Self> {
        if hold == 0 {
            return Err(Error::invalid_param("a command is held for 0 steps; give at least 1"));
        }
        let mut spec = inner.spec().clone();
        if controller.actions() != spec.action.len() {
            return Err(Error::invalid_input(format!(
                "actions of {} numbers in {}, whose actions are {}; select a controller of this environment",
                controller.actions(),
                spec.id,
                spec.action
            )));
        }
        let (seen, action) = (vec![0.0; spec.observation.len()], vec![0.0; spec.action.len()]);
        spec.action = controller.commands().clone();
        spec.max_episode_steps = spec.max_episode_steps.map(|steps| steps.div_ceil(hold));
        spec.reward_range = (
            spec.reward_range.0.min(spec.reward_range.0 * f64::from(hold)),
            spec.reward_range.1.max(spec.reward_range.1 * f64::from(hold)),
        );
        Ok(Self { inner, controller, hold, spec, seen, action })
    }
}

impl<E: Environment, C: CommandedController> Environment for Commanded<E, C> {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let info = self.inner.reset(seed, options, observation)?;
        self.controller.reset();
        self.seen.copy_from_slice(observation);
        Ok(info)
    }

    fn step(&mut self, command: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.spec.action.check(command)?;
        let mut earned = 0.0;
        for left in (0..self.hold).rev() {
            self.controller.follow(&self.seen, command, &mut self.action)?;
            let step = self.inner.step(&self.action, observation)?;
            self.seen.copy_from_slice(observation);
            earned += step.reward;
            if step.is_over() || left == 0 {
                return Ok(Step { reward: earned, ..step });
            }
        }
        Err(Error::internal("a command that is held for no step"))
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.extend_numbers(self.seen.iter().map(|number| f64::from(*number)));
        self.controller.save_state(snapshot)?;
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        for number in &mut self.seen {
            *number = state.number()? as f32;
        }
        self.controller.load_state(state)?;
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}
