//! What a prior and a policy are worth, alone and together.

use std::fmt;

use opendr_engine::environment::{Controller, Environment, Step};
use opendr_engine::{Result, ResultExt as _, Statistics};
use serde::{Serialize, Serializer};

use super::ShieldedController;
use crate::evaluation::{EvaluationProtocol, EvaluationReport, evaluate_controller};

/// Prior, policy and both on the same fixed episodes.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(transparent)]
pub struct PriorReport {
    /// What was measured, in the order in which it was added.
    pub rows: Vec<ReportedController>,
}

/// One controller of a [`PriorReport`].
#[derive(Debug, Clone, PartialEq)]
pub struct ReportedController {
    /// Name in the table: `prior`, `policy`, `both`.
    pub name: String,
    /// Success, returns and lengths.
    pub evaluation: EvaluationReport,
    /// The share of steps in which a shield replaced the action, where there is a shield.
    pub shielded: Option<f64>,
}

impl PriorReport {
    /// Evaluates a controller and adds its row. An episode is a success where the info of its last step has a `success` above 0.5.
    ///
    /// # Errors
    /// As [`evaluate_controller`].
    pub fn add(
        &mut self,
        name: &str,
        controller: &mut dyn Controller,
        environment: &mut dyn Environment,
        protocol: &EvaluationProtocol,
    ) -> Result<()> {
        let success = |step: &Step| step.info.success();
        let evaluation = evaluate_controller(controller, environment, protocol, &success)
            .context(|| format!("measuring {name}"))?;
        self.rows.push(ReportedController { name: name.to_owned(), evaluation, shielded: None });
        Ok(())
    }

    /// Adds a controller under a shield, with the share of steps in which the fallback acted.
    ///
    /// # Errors
    /// As [`Self::add`].
    pub fn add_shielded<C: Controller>(
        &mut self,
        name: &str,
        controller: &mut ShieldedController<C>,
        environment: &mut dyn Environment,
        protocol: &EvaluationProtocol,
    ) -> Result<()> {
        controller.restart_count();
        self.add(name, controller, environment, protocol)?;
        if let Some(row) = self.rows.last_mut() {
            row.shielded = Some(controller.shielded_share());
        }
        Ok(())
    }
}

impl Serialize for ReportedController {
    /// Name, scalars and share of shielded steps.
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Row<'a> {
            name: &'a str,
            #[serde(flatten)]
            scalars: std::collections::BTreeMap<String, f64>,
            #[serde(skip_serializing_if = "Option::is_none")]
            shielded: Option<f64>,
        }
        let scalars = Statistics::from(&self.evaluation).scalars;
        Row { name: &self.name, scalars, shielded: self.shielded }.serialize(serializer)
    }
}

impl fmt::Display for PriorReport {
    /// A Markdown table.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "| controller | success, % | 95 % interval | mean return | shielded steps, % |")?;
        writeln!(f, "|---|---|---|---|---|")?;
        for ReportedController { name, evaluation, shielded } in &self.rows {
            write!(f, "| {name} | ")?;
            match evaluation.success {
                Some(success) => {
                    let [low, high] = success.interval.map(|share| 100.0 * share);
                    write!(f, "{:.1} | {low:.1} to {high:.1} | ", 100.0 * success.rate)?;
                }
                None => write!(f, "| | ")?,
            }
            write!(f, "{:.1} | ", evaluation.mean_return)?;
            match shielded {
                Some(shielded) => writeln!(f, "{:.1} |", 100.0 * shielded)?,
                None => writeln!(f, "|")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prior::Shield;

    #[test]
    fn rows_stand_beside_each_other() {
        let mut environment = opendr_simulation::make("CartPole-v1").unwrap();
        let protocol = EvaluationProtocol { episodes: 3, ..EvaluationProtocol::default() };
        let mut report = PriorReport::default();
        let right = |_: &[f32], action: &mut [f32]| {
            action[0] = 1.0;
            Ok(())
        };
        report.add("policy", &mut { right }, &mut *environment, &protocol).unwrap();
        // To the left in every second step: the pole falls later.
        let mut step = 0;
        let every_second = move |_: &[f32], _: &[f32]| {
            step += 1;
            step % 2 == 0
        };
        let left = |_: &[f32], action: &mut [f32]| {
            action[0] = 0.0;
            Ok(())
        };
        let mut shielded = ShieldedController::new(right, Shield::new(every_second, Box::new(left)));
        report.add_shielded("both", &mut shielded, &mut *environment, &protocol).unwrap();
        let [policy, both] = &report.rows[..] else { panic!("{report}") };
        assert_eq!((policy.evaluation.episodes.len(), policy.shielded), (3, None));
        assert!((0.4..=0.5).contains(&both.shielded.unwrap()), "{report}");
        assert!(both.evaluation.mean_return > 2.0 * policy.evaluation.mean_return, "{report}");
        assert_eq!(report.to_string().lines().count(), 4);
    }
}
