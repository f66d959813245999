//! The update from a rollout.

use opendr_engine::Result;
use opendr_kernels::clip_gradient_norm;

use super::Ppo;
use super::minibatch::{ActorLoss, Weights};
use crate::algorithm::diverged;

/// Steps per minibatch from which actor and critic run on a thread each.
const PARALLEL_FROM: usize = 64;

/// Sums over the minibatches of an update.
#[derive(Default)]
struct Sums {
    minibatches: f64,
    policy: f64,
    entropy: f64,
    value: f64,
    clip_fraction: f64,
    /// Sum and count of the last epoch.
    approx_kl: [f64; 2],
}

impl Ppo {
    /// Trains on the rollout in minibatches, `n_epochs` times.
    pub(super) fn update(&mut self, timesteps: u64, total_timesteps: u64) -> Result<()> {
        let (learning_rate, clip_range) = self.schedules(timesteps, total_timesteps);
        let config = &self.config;
        let weights = Weights {
            clip_range,
            clip_range_vf: config.clip_range_vf,
            entropy: config.ent_coef,
            value: config.vf_coef,
        };
        let mut sums = Sums::default();
        let mut order = std::mem::take(&mut self.rollout.order);
        let mut outcome = Ok(());
        let sequences = (self.config.batch_size / self.rollout.length).max(1);
        'epochs: for _ in 0..self.config.n_epochs {
            sums.approx_kl = [0.0; 2];
            self.random.shuffle(&mut order);
            for places in order.chunks(sequences) {
                outcome = self.pass(places, weights, timesteps);
                let (actor, critic) = (self.memory.actor.loss, self.memory.critic.loss);
                sums.add(actor, critic);
                let moved_too_far =
                    self.config.target_kl.is_some_and(|target| actor.approx_kl > 1.5 * target);
                if outcome.is_err() || moved_too_far {
                    break 'epochs;
                }
                outcome = self.step(learning_rate, timesteps);
                if outcome.is_err() {
                    break 'epochs;
                }
            }
            self.updates += 1;
        }
        self.rollout.order = order;
        outcome?;
        self.report_metrics(&sums, learning_rate, clip_range);
        Ok(())
    }

    /// Computes losses and gradients of the sequences with the indices `places`.
    fn pass(&mut self, places: &[usize], weights: Weights, timesteps: u64) -> Result<()> {
        let Self { policy, compute, critic, critic_parameters, memory, rollout, .. } = self;
        let steps = &mut memory.minibatch;
        steps.gather(rollout, places, self.config.normalize_advantage);
        let steps = &*steps;
        let count = policy.extractor.parameters();
        let extractor_parameters = &policy.parameters[..count];
        let features = policy.extractor.forward(
            compute,
            extractor_parameters,
            &steps.observations,
            &mut memory.extractor,
        );
        let wants_input = !policy.extractor.is_identity();
        let (actor_pass, critic_pass) = (&mut memory.actor, &mut memory.critic);
        let mut actor = || actor_pass.run(compute, policy, features, steps, weights, wants_input);
        let mut critic = || {
            critic_pass.run(compute, critic, critic_parameters, features, steps, weights, wants_input);
        };
        if places.len() * rollout.length < PARALLEL_FROM {
            actor();
            critic();
        } else {
            compute.pool().join(actor, critic);
        }
        if wants_input {
            let both = memory.actor.dfeatures.iter().zip(&memory.critic.dfeatures);
            memory.dfeatures.clear();
            memory.dfeatures.extend(both.map(|(actor, critic)| actor + critic));
            let gradients = &mut memory.actor.gradients[..count];
            let (dfeatures, extractor) = (&memory.dfeatures, &mut memory.extractor);
            policy.extractor.backward(compute, extractor_parameters, dfeatures, extractor, gradients);
        }
        for (what, loss) in
            [("the loss of the policy", memory.actor.loss.policy), ("the loss of values", memory.critic.loss)]
        {
            if !loss.is_finite() {
                return Err(diverged(what, loss.into(), timesteps));
            }
        }
        Ok(())
    }

    /// Takes a gradient step; fails if the gradients are not finite.
    fn step(&mut self, learning_rate: f32, timesteps: u64) -> Result<()> {
        let (actor, critic) = (&mut self.memory.actor.gradients, &mut self.memory.critic.gradients);
        let norm = clip_gradient_norm(&mut [actor, critic], self.config.max_grad_norm);
        if !norm.is_finite() {
            return Err(diverged("the norm of the gradient", norm.into(), timesteps));
        }
        if timesteps > self.config.actor_starts {
            self.actor_adam.step(&self.compute, learning_rate, &mut self.policy.parameters, actor);
        }
        self.critic_adam.step(&self.compute, learning_rate, &mut self.critic_parameters, critic);
        Ok(())
    }

    fn report_metrics(&mut self, sums: &Sums, learning_rate: f32, clip_range: f32) {
        let mean = |sum: f64| sum / sums.minibatches.max(1.0);
        let metrics = &mut self.report.metrics;
        metrics.set("policy_gradient_loss", mean(sums.policy));
        metrics.set("value_loss", mean(sums.value));
        metrics.set("entropy_loss", -mean(sums.entropy));
        metrics.set("approx_kl", sums.approx_kl[0] / sums.approx_kl[1].max(1.0));
        metrics.set("clip_fraction", mean(sums.clip_fraction));
        metrics.set("explained_variance", self.rollout.explained_variance());
        metrics.set("learning_rate", learning_rate.into());
        metrics.set("clip_range", clip_range.into());
        metrics.set("n_updates", self.updates as f64);
        let log_std = self.policy.log_std();
        if !log_std.is_empty() {
            let sum: f64 = log_std.iter().map(|log_std| f64::from(log_std.exp())).sum();
            metrics.set("std", sum / log_std.len() as f64);
        }
    }
}

impl Sums {
    fn add(&mut self, actor: ActorLoss, value: f32) {
        self.minibatches += 1.0;
        self.policy += f64::from(actor.policy);
        self.entropy += f64::from(actor.entropy);
        self.value += f64::from(value);
        self.clip_fraction += f64::from(actor.clip_fraction);
        self.approx_kl[0] += f64::from(actor.approx_kl);
        self.approx_kl[1] += 1.0;
    }
}
