//! The controllers of a policy's report: prior, policy and both, with and without a shield.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_engine::environment::{Controller, Space};
use opendr_engine::model::Model;
use opendr_engine::params::{ParamMap, Params as _};

use super::prior_record::PriorRecord;
use super::residual_controller::inner_spaces;
use super::residual_learner::own_shield;
use super::shaping_config::CommandRecord;
use super::{BoxedController, CommandingPolicy, Prior, ResidualController, Shield};
use crate::evaluation::policy_controller;
use crate::learner::PolicyParams;
use crate::policy::Policy;
use crate::training::POLICY_FILE;

/// A controller of a report.
pub struct ModelController {
    name: &'static str,
    controller: BoxedController,
    shield: Option<Shield>,
}

impl ModelController {
    /// Returns its name in the report.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the share of steps in which the shield replaced the action; none without a shield.
    pub fn shielded_share(&self) -> Option<f64> {
        self.shield.as_ref().map(Shield::shielded_share)
    }
}

impl Controller for ModelController {
    fn reset(&mut self) {
        self.controller.reset();
        self.shield.iter_mut().for_each(Shield::reset);
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.controller.act(observation, action)?;
        if let Some(shield) = &mut self.shield
            && shield.arbitrate(observation, action)?
        {
            self.controller.executed(action);
        }
        Ok(())
    }
}

/// Returns the controllers of a policy that has a prior or a shield: prior, policy and both, then what is deployed under the shield;
/// none for a container without either. A policy of commands does nothing alone, so that it has no row of its own. `params` are the parameters of its learner, with those of [`PolicyParams`].
///
/// # Errors
/// `Format` for a damaged container, `NotFound` for an unknown prior or rule.
pub fn controllers_of_model(model: &Model, params: &ParamMap) -> Result<Option<Vec<ModelController>>> {
    let record = PriorRecord::of(model)?;
    let Ok(params) = PolicyParams::from_map(params) else { return Ok(None) };
    if let Some(record) = CommandRecord::of(model)? {
        return commanded_controllers(model, &params, &record).map(Some);
    }
    if record.is_none() && params.shield.shield.is_none() {
        return Ok(None);
    }
    let policy = Arc::new(Policy::from_bytes(&model.file(POLICY_FILE)?)?);
    let seed = (!params.deterministic).then_some(params.seed);
    let Some(record) = record else {
        let shield = params.shield.shield(policy.observation())?;
        let alone = || -> BoxedController { Box::new(policy_controller(Arc::clone(&policy), seed)) };
        return Ok(Some(vec![
            ModelController { name: "policy", controller: alone(), shield: None },
            ModelController { name: "policy, shielded", controller: alone(), shield },
        ]));
    };
    let prior = Prior::find(&record.id)?;
    let space: &Space = inner_spaces(&policy)?.0;
    let corrected = || -> Result<_> {
        let policy = Arc::clone(&policy);
        let mut both = ResidualController::new(policy, prior.controller(space)?, record.alpha)?;
        both.set_sampled(seed);
        Ok(both)
    };
    let row = |name, controller| ModelController { name, controller, shield: None };
    let mut rows = vec![
        row("prior", prior.controller(space)?),
        row("policy", Box::new(corrected()?.without_prior())),
        row("prior and policy", Box::new(corrected()?)),
    ];
    if let Some(shield) = own_shield(&params.shield, &prior, space)? {
        let controller = Box::new(corrected()?);
        rows.push(ModelController { name: "prior and policy, shielded", controller, shield: Some(shield) });
    }
    Ok(Some(rows))
}

/// Returns the controllers of a policy of commands: its prior without commands, and the prior that follows them.
fn commanded_controllers(
    model: &Model,
    params: &PolicyParams,
    record: &CommandRecord,
) -> Result<Vec<ModelController>> {
    let policy = Arc::new(Policy::from_bytes(&model.file(POLICY_FILE)?)?);
    let (prior, space) = (Prior::find(&record.id)?, policy.observation());
    let both = || -> Result<BoxedController> {
        let mut both = CommandingPolicy::new(Arc::clone(&policy), prior.commanded(space)?, record.hold)?;
        both.set_sampled((!params.deterministic).then_some(params.seed));
        Ok(Box::new(both))
    };
    let row = |name, controller| ModelController { name, controller, shield: None };
    let mut rows = vec![row("prior", prior.controller(space)?), row("prior and policy", both()?)];
    if let Some(shield) = own_shield(&params.shield, &prior, space)? {
        let shield = Some(shield);
        rows.push(ModelController { name: "prior and policy, shielded", controller: both()?, shield });
    }
    Ok(rows)
}
