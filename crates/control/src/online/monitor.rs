//! Whether the adaptation is better than the base would be.

use opendr_engine::environment::TrackingTask;
use opendr_engine::params::Params;

use super::response::{Response, Stages};

/// Parameters of a [`Monitor`].
#[derive(Debug, Clone, Copy, PartialEq, Params)]
pub struct MonitorParams {
    /// Time over which costs are averaged.
    #[param(default = 1.5, range = 0.01..=1000.0, unit = "s")]
    pub window: f64,
    /// Ratio of the costs from which the adaptation is worse.
    #[param(default = 1.4, range = 1.0..=1000.0)]
    pub tolerance: f64,
    /// Errors up to this are never worse, in units of the error.
    #[param(default = 0.05, range = 0.0..=1e6)]
    pub floor: f64,
    /// First pause of learning after a rollback; it doubles with each further one.
    #[param(default = 2.0, range = 0.0..=1e6, unit = "s")]
    pub pause: f64,
    /// Rollbacks without a good time between them after which learning is switched off.
    #[param(default = 3, range = 1..=1000)]
    pub strikes: u32,
    /// A good time: so long the cost was below 0.8 of the base's.
    #[param(default = 3.0, range = 0.0..=1e6, unit = "s")]
    pub good_time: f64,
}

/// Predicts the error that the frozen base would have now, from the difference of the commands.
///
/// Beside the error `e` of the adapted controller it integrates the displacement `d` that the adaptation caused, as the closed loop
/// of the base would answer to the difference of the commands: `d'' + damping d' + stiffness d = adapted - base`. The base's error
/// is then about `e + d`, whatever disturbs both. Costs are running means of squared errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Monitor {
    params: MonitorParams,
    period: f64,
    loops: Vec<(Response, [f64; 2])>,
    axes: Vec<Displacement>,
    /// Running means of squared errors: adapted, base.
    costs: [f64; 2],
    /// Seconds since the last rollback.
    since: f64,
    good_for: f64,
}

#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Displacement {
    /// The difference of the commands behind the response of the plant.
    push: Stages,
    speed: f64,
    way: f64,
}

/// What a monitor finds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Neither better nor worse for long enough.
    Undecided,
    /// The adaptation was better for a good time.
    Good,
    /// The adaptation is worse.
    Worse,
}

impl Monitor {
    /// Creates a monitor of a task whose base closes about the conventional loop.
    pub fn new(params: MonitorParams, task: &TrackingTask) -> Self {
        let period = task.period;
        let loops = task.axes.iter().map(|axis| {
            let response = Response::new(axis.response as f32, 0.0, period as f32);
            (response, [axis.stiffness, axis.damping])
        });
        let axes = vec![Displacement::default(); task.axes.len()];
        Self { params, period, loops: loops.collect(), axes, costs: [0.0; 2], since: 0.0, good_for: 0.0 }
    }

    /// Forgets the past of the last episode.
    pub fn reset(&mut self) {
        self.axes.fill(Displacement::default());
        (self.costs, self.since, self.good_for) = ([0.0; 2], 0.0, 0.0);
    }

    /// Takes in the errors of this step and the commands of the last one, adapted and base.
    pub fn observe(&mut self, errors: &[f32], adapted: &[f32], base: &[f32]) -> Verdict {
        let MonitorParams { window, tolerance, floor, .. } = self.params;
        let mut squares = [0.0; 2];
        for (at, (axis, (response, [stiffness, damping]))) in
            self.axes.iter_mut().zip(&self.loops).enumerate()
        {
            response.advance(&mut axis.push, adapted[at] - base[at]);
            let push = f64::from(axis.push[1]);
            axis.speed += (push - damping * axis.speed - stiffness * axis.way) * self.period;
            axis.way += axis.speed * self.period;
            let error = f64::from(errors[at]);
            squares[0] += error * error;
            squares[1] += (error + axis.way).powi(2);
        }
        for (cost, square) in self.costs.iter_mut().zip(squares) {
            *cost += (square - *cost) * (self.period / window);
        }
        self.since += self.period;
        let [adapted, base] = self.costs;
        self.good_for = if adapted < 0.8 * base { self.good_for + self.period } else { 0.0 };
        if self.since > window && adapted > tolerance * tolerance * base + floor * floor {
            return Verdict::Worse;
        }
        if self.good_for > self.params.good_time { Verdict::Good } else { Verdict::Undecided }
    }

    /// Returns the root mean squares of the recent errors: adapted, and predicted of the base.
    pub fn errors(&self) -> [f64; 2] {
        self.costs.map(f64::sqrt)
    }

    /// Judges anew after a rollback: both costs start equal.
    pub(super) fn restart(&mut self) {
        self.costs[0] = self.costs[1];
        (self.since, self.good_for) = (0.0, 0.0);
    }

    /// Begins another time of the same length before the next good one.
    pub(super) fn count_good_again(&mut self) {
        self.good_for = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::environment::{TrackingAxis, TrackingLayout};

    use super::*;

    /// A plant of one axis with a load, flown by the base plus a push.
    fn fly(push: f64, load: f64) -> (Verdict, [f64; 2]) {
        let (stiffness, damping) = (5.0, 6.0);
        let layout = TrackingLayout {
            len: 2,
            axes: 1,
            error: 0,
            rate: 1,
            reference: [0, 0],
            velocity: None,
            feedforward: None,
            age: None,
            saturated: None,
        };
        let task = TrackingTask {
            layout,
            period: 0.01,
            axes: vec![TrackingAxis { response: 0.0, stiffness, damping }],
        };
        let mut monitor = Monitor::new(MonitorParams::default(), &task);
        let (mut position, mut speed, mut verdict) = (0.0, 0.0, Verdict::Undecided);
        for _ in 0..1000 {
            let base = -stiffness * position - damping * speed;
            speed += (base + push + load) * 0.01;
            position += speed * 0.01;
            verdict = monitor.observe(&[-position as f32], &[(base + push) as f32], &[base as f32]);
        }
        (verdict, monitor.errors())
    }

    /// The error of the base is predicted exactly where the model is exact.
    #[test]
    fn the_error_of_the_base_is_predicted() {
        let (verdict, [adapted, base]) = fly(-2.0, 2.0);
        assert_eq!(verdict, Verdict::Good);
        assert!(adapted < 1e-3 && (base - 0.4).abs() < 0.01, "{adapted} {base}");
        let (verdict, [adapted, base]) = fly(2.0, 2.0);
        assert_eq!(verdict, Verdict::Worse);
        assert!((adapted - 0.8).abs() < 0.02 && (base - 0.4).abs() < 0.01, "{adapted} {base}");
        assert_eq!(fly(0.0, 2.0).0, Verdict::Undecided);
    }
}
