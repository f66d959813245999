//! Environments whose episodes a page displays while a command acts in them.

use std::sync::Arc;
use std::time::{Duration, Instant};

use opendr::data::Image;
use opendr::environment::{
    Environment, EnvironmentSource, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};
use opendr::learner::Outputs;
use opendr::viewer::{Shown, Viewer};
use opendr::{Error, Result};

use crate::viewing;

/// Shortest time between two images: rendering takes longer than most steps.
const FRAME: Duration = Duration::from_millis(33);

/// Environments from a source, displayed on a page if there is one.
pub struct ViewedSource<'a> {
    source: &'a dyn EnvironmentSource,
    viewer: Option<Arc<Viewer>>,
}

impl<'a> ViewedSource<'a> {
    /// Creates the source; without a page its environments are those of `source`.
    pub fn new(source: &'a dyn EnvironmentSource, viewer: Option<Viewer>) -> Self {
        Self { source, viewer: viewer.map(Arc::new) }
    }
}

impl EnvironmentSource for ViewedSource<'_> {
    fn make(&self) -> Result<Box<dyn Environment>> {
        let inner = self.source.make()?;
        Ok(match &self.viewer {
            None => inner,
            Some(viewer) => Box::new(ViewedEnvironment {
                inner,
                viewer: viewer.clone(),
                episode: String::new(),
                steps: 0,
                earned: 0.0,
                due: Instant::now(),
            }),
        })
    }
}

/// An environment that displays some of its states, at most one in each [`FRAME`].
struct ViewedEnvironment {
    inner: Box<dyn Environment>,
    viewer: Arc<Viewer>,
    /// Name of the environment and seed of the episode.
    episode: String,
    steps: u64,
    /// Sum of the rewards of the episode.
    earned: f64,
    /// When the next image may be displayed.
    due: Instant,
}

impl ViewedEnvironment {
    /// Displays the present state when an image is due.
    fn display(&mut self, notes: impl FnOnce(f64) -> Vec<(String, String)>) -> Result<()> {
        let now = Instant::now();
        if now < self.due {
            return Ok(());
        }
        self.due = now + FRAME;
        let image = rendered(self.inner.as_mut())?;
        let shown = viewing::shown(self.episode.clone(), self.steps, (&image).into(), &Outputs::default());
        self.viewer.show(Shown { notes: notes(self.earned), ..shown });
        Ok(())
    }
}

impl Environment for ViewedEnvironment {
    fn spec(&self) -> &EnvironmentSpec {
        self.inner.spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let info = self.inner.reset(seed, options, observation)?;
        let id = &self.inner.spec().id;
        self.episode = seed.map_or_else(|| id.clone(), |seed| episode_name(id, seed));
        (self.steps, self.earned) = (0, 0.0);
        self.display(|_| Vec::new())?;
        Ok(info)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let step = self.inner.step(action, observation)?;
        self.steps += 1;
        self.earned += step.reward;
        self.display(|earned| notes(&step, earned, action))?;
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}

/// Returns an image of the state of an environment.
///
/// # Errors
/// `Unsupported` for an environment that does not render.
pub fn rendered(environment: &mut dyn Environment) -> Result<Image> {
    let image = environment.render()?;
    image.ok_or_else(|| Error::unsupported(format!("{} does not render", environment.spec().id)))
}

/// Returns the name of an episode on a page.
pub fn episode_name(id: &str, seed: u64) -> String {
    format!("{id} seed {seed}")
}

/// Returns what a page displays beside the image of a step.
pub fn notes(step: &Step, earned: f64, action: &[f32]) -> Vec<(String, String)> {
    let action: Vec<_> = action.iter().map(|value| format!("{value:.3}")).collect();
    let info = step.info.iter().map(|(name, value)| (name.to_string(), format!("{value:.3}")));
    let own = [
        ("reward", format!("{:.3}", step.reward)),
        ("return", format!("{earned:.3}")),
        ("action", action.join(", ")),
    ];
    own.into_iter().map(|(name, text)| (name.to_owned(), text)).chain(info).collect()
}

#[cfg(test)]
mod tests {
    use opendr::viewer::ViewerOptions;

    use super::*;

    /// An environment without a camera.
    struct Dark(EnvironmentSpec);

    impl Environment for Dark {
        fn spec(&self) -> &EnvironmentSpec {
            &self.0
        }

        fn reset(&mut self, _: Option<u64>, _: &ResetOptions, _: &mut [f32]) -> Result<Info> {
            Ok(Info::default())
        }

        fn step(&mut self, _: &[f32], _: &mut [f32]) -> Result<Step> {
            Ok(Step::default())
        }
    }

    fn viewer() -> Option<Viewer> {
        Some(Viewer::bind("127.0.0.1:0".parse().unwrap(), ViewerOptions::default()).unwrap())
    }

    #[test]
    fn a_page_changes_no_step() {
        let cart = || opendr::simulation::make("CartPole-v1");
        let (mut plain, mut viewed) = (cart().unwrap(), ViewedSource::new(&cart, viewer()).make().unwrap());
        let (mut one, mut other) = ([0.0; 4], [0.0; 4]);
        for seed in 0..3 {
            plain.reset(Some(seed), &ResetOptions::new(), &mut one).unwrap();
            viewed.reset(Some(seed), &ResetOptions::new(), &mut other).unwrap();
            loop {
                let [step, same] = [plain.step(&[1.0], &mut one), viewed.step(&[1.0], &mut other)];
                let (step, same) = (step.unwrap(), same.unwrap());
                assert_eq!((&step, one), (&same, other));
                if step.is_over() {
                    break;
                }
            }
        }
        assert_eq!(viewed.snapshot().unwrap(), plain.snapshot().unwrap());
    }

    #[test]
    fn an_environment_that_does_not_render_is_refused_by_a_page_alone() {
        let dark = || -> Result<Box<dyn Environment>> {
            let space = opendr::environment::Space::discrete(2);
            Ok(Box::new(Dark(EnvironmentSpec::new("Dark-v0", space.clone(), space))))
        };
        let reset = |viewer| {
            let mut environment = ViewedSource::new(&dark, viewer).make().unwrap();
            environment.reset(Some(1), &ResetOptions::new(), &mut [0.0]).map(drop)
        };
        reset(None).unwrap();
        assert_eq!(reset(viewer()).unwrap_err().to_string(), "Dark-v0 does not render");
    }
}
