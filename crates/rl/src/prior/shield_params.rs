//! The shield of a policy as parameters.

use opendr_engine::environment::Space;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result};

use super::{Prior, SafetyRule, Shield};

/// Parameters of a shield, for training and inference.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ShieldParams {
    /// Name of the safety rule that decides which actions are replaced (`opendr sim priors` lists the rules); none disables the shield.
    pub shield: Option<String>,
    /// Name of the prior that acts instead, in its newest version; none means the policy's own prior.
    pub shield_prior: Option<String>,
}

impl ShieldParams {
    /// Creates the shield for a policy without a prior of its own, with observations of `space`; none where it is disabled.
    ///
    /// # Errors
    /// `InvalidParam` where a prior is missing or given without a rule; as [`SafetyRule::find`] and [`Prior::newest`].
    pub fn shield(&self, space: &Space) -> Result<Option<Shield>> {
        match (&self.shield, &self.shield_prior) {
            (None, None) => Ok(None),
            (Some(rule), Some(prior)) => {
                let fallback = Prior::newest(prior)?.controller(space)?;
                Ok(Some(Shield::new(SafetyRule::find(rule)?.predicate(space)?, fallback)))
            }
            (Some(rule), None) => Err(Error::invalid_param(format!(
                "shield is {rule}, and this policy has no prior of its own; name the one that acts instead by shield_prior"
            ))),
            (None, Some(prior)) => Err(rule_missing(prior)),
        }
    }

    /// Returns the safety rule of a policy with a prior of its own; none where the shield is disabled.
    ///
    /// # Errors
    /// `InvalidParam` where another prior is given; as [`SafetyRule::find`].
    pub fn own_rule(&self) -> Result<Option<SafetyRule>> {
        match (&self.shield, &self.shield_prior) {
            (None, None) => Ok(None),
            (Some(rule), None) => SafetyRule::find(rule).map(Some),
            (Some(_), Some(prior)) => Err(Error::invalid_param(format!(
                "shield_prior is {prior}, but the prior that this policy corrects acts instead; omit shield_prior"
            ))),
            (None, Some(prior)) => Err(rule_missing(prior)),
        }
    }
}

fn rule_missing(prior: &str) -> Error {
    Error::invalid_param(format!("shield_prior is {prior} without a rule; name one by shield, or omit it"))
}
