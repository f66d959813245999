//! Learning rate schedules.

use std::f64::consts::PI;

use crate::params::{ScheduleKind, TrainingParams};

/// Learning rate of every step. It depends on the step alone, so a resumed training has the same rates.
#[derive(Debug, Clone)]
pub struct Schedule {
    kind: ScheduleKind,
    lr: f64,
    lr_min: f64,
    gamma: f64,
    warmup_steps: u64,
    warmup_ratio: f64,
    /// Steps at which `step` lowers the learning rate.
    marks: Vec<u64>,
    steps: u64,
}

impl Schedule {
    /// Creates the schedule of a training of `steps` steps, `steps_per_epoch` per epoch.
    pub fn new(params: &TrainingParams, steps: u64, steps_per_epoch: u64) -> Self {
        let mark = |epoch: &i64| u64::try_from(*epoch).unwrap_or(0).saturating_mul(steps_per_epoch);
        Self {
            kind: params.lr_schedule,
            lr: params.lr,
            lr_min: params.lr_min.min(params.lr),
            gamma: params.lr_gamma,
            warmup_steps: params.warmup_steps.min(steps),
            warmup_ratio: params.warmup_ratio,
            marks: params.lr_steps.iter().map(mark).collect(),
            steps,
        }
    }

    /// Returns the learning rate of step `step`, from 0.
    pub fn lr(&self, step: u64) -> f64 {
        if step < self.warmup_steps {
            let share = (step + 1) as f64 / (self.warmup_steps + 1) as f64;
            return self.lr * (self.warmup_ratio + (1.0 - self.warmup_ratio) * share);
        }
        let rest = self.steps.saturating_sub(self.warmup_steps).max(1);
        let share = ((step - self.warmup_steps) as f64 / rest as f64).min(1.0);
        match self.kind {
            ScheduleKind::Constant => self.lr,
            ScheduleKind::Step => {
                let passed = self.marks.iter().filter(|mark| step >= **mark).count();
                self.lr * self.gamma.powi(passed as i32)
            }
            ScheduleKind::Cosine => self.lr_min + (self.lr - self.lr_min) * 0.5 * (1.0 + (PI * share).cos()),
            ScheduleKind::Linear => self.lr + (self.lr_min - self.lr) * share,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn params(kind: ScheduleKind) -> TrainingParams {
        TrainingParams { lr: 1.0, lr_schedule: kind, ..TrainingParams::default() }
    }

    #[test]
    fn warm_up_rises_to_the_rate() {
        let params = TrainingParams { warmup_steps: 4, warmup_ratio: 0.5, ..params(ScheduleKind::Constant) };
        let schedule = Schedule::new(&params, 100, 10);
        let rates: Vec<f64> = (0..6).map(|step| schedule.lr(step)).collect();
        assert_eq!(rates, [0.6, 0.7, 0.8, 0.9, 1.0, 1.0]);
    }

    #[test]
    fn steps_multiply() {
        let params = TrainingParams { lr_steps: vec![2, 3], ..params(ScheduleKind::Step) };
        let schedule = Schedule::new(&params, 50, 10);
        assert_eq!([19, 20, 29, 30].map(|step| schedule.lr(step)), [1.0, 0.1, 0.1, 0.1 * 0.1]);
    }

    #[test]
    fn cosine_and_linear_end_at_lr_min() {
        for kind in [ScheduleKind::Cosine, ScheduleKind::Linear] {
            let params = TrainingParams { lr_min: 0.2, ..params(kind) };
            let schedule = Schedule::new(&params, 100, 10);
            assert_eq!(schedule.lr(0), 1.0);
            assert!((schedule.lr(50) - 0.6).abs() < 1e-12);
            assert!((schedule.lr(100) - 0.2).abs() < 1e-12 && (schedule.lr(1000) - 0.2).abs() < 1e-12);
            assert!((1..=100).all(|step| schedule.lr(step) < schedule.lr(step - 1)));
        }
    }
}
