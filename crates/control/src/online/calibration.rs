//! What an adapter must know of a policy, from flights of the frozen policy.

use opendr_engine::environment::{Environment, ResetOptions};
use opendr_engine::{Random, Result};

use super::requirements::{tracking_bounds, tracking_task};
use super::{AdaptablePolicy, Envelope, ReferenceFeatures};

/// Region of observations and features of a policy.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// The region in which the policy is trusted.
    pub envelope: Envelope,
    /// What of its last layer is adapted.
    pub features: ReferenceFeatures,
}

/// Episodes of the frozen policy, and the most steps of each that are used.
const EPISODES: u64 = 12;
const STEPS: usize = 4000;
/// Seed of the first episode: evaluations begin elsewhere.
const FIRST_SEED: u64 = 5000;
/// Errors and rates are spread by what the conventional law answers with this share of the largest command.
const SPREAD: f64 = 0.2;
/// Share of the span by which the envelope is wider than what was observed.
const MARGIN: f32 = 0.2;
/// Rows between those that are kept, so that neighbours differ.
const EVERY: usize = 4;

impl Calibration {
    /// Flies the frozen policy in an environment that states a tracking task, and spreads the errors that it observes.
    ///
    /// # Errors
    /// `Unsupported` for an environment without a tracking task, and those of policy and environment.
    pub fn fly<P: AdaptablePolicy>(policy: &P, environment: &mut dyn Environment) -> Result<Self> {
        let spec = environment.spec().clone();
        let task = tracking_task(&spec)?.clone();
        task.check()?;
        let (low, high) = tracking_bounds(&spec, &task)?;
        let limits: Vec<_> = low.iter().zip(high).map(|(low, high)| 0.5 * f64::from(high - low)).collect();
        let (layout, mut policy) = (task.layout, policy.clone());
        let (mut observation, mut action) = (vec![0.0; spec.observation.len()], vec![0.0; spec.action.len()]);
        layout.check_lengths(&observation, &action)?;
        let mut random = Random::from_key([FIRST_SEED, 1]);
        let mut rows = Vec::new();
        for episode in 0..EPISODES {
            environment.reset(Some(FIRST_SEED + episode), &ResetOptions::new(), &mut observation)?;
            for step in 0..STEPS {
                policy.act(&observation, &mut action)?;
                if step % EVERY == 0 {
                    let first = rows.len();
                    rows.extend_from_slice(&observation);
                    let row = &mut rows[first..];
                    for (at, (axis, limit)) in task.axes.iter().zip(&limits).enumerate() {
                        let wide = SPREAD * limit * 2.0 * random.unit();
                        row[layout.error + at] += (wide / axis.stiffness.max(1e-6) * random.normal()) as f32;
                        row[layout.rate + at] += (wide / axis.damping.max(1e-6) * random.normal()) as f32;
                    }
                    // Both are observed in flight and may not matter.
                    if let Some(age) = layout.age {
                        row[age] = random.uniform(0.0, 0.4);
                    }
                    if let Some(saturated) = layout.saturated {
                        row[saturated] = f32::from(random.chance(0.5));
                    }
                }
                if environment.step(&action, &mut observation)?.is_over() {
                    break;
                }
            }
        }
        Ok(Self {
            envelope: Envelope::of(&rows, layout.len, MARGIN)?,
            features: ReferenceFeatures::of(&mut policy, &rows, &layout)?,
        })
    }
}
