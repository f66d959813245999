//! A residual block that a condition modulates.

use opendr_engine::{Random, Result};
use opendr_kernels::{Activation, Compute, Dense, Gelu, LayerNorm};

use crate::parts::{split, split_mut};
use crate::transformer::{add, initialise_dense, initialise_norm};

/// The block `x + V gelu(W (norm(x) (1 + s) + t))`, where the condition gives scale s and shift t (adaptive normalisation: Peebles and
/// Xie, 2023; without it, FiLM of the paper's network: Perez et al., 2018).
#[derive(Debug, Clone)]
pub(super) struct Modulated {
    norm: LayerNorm,
    condition: Dense,
    feed: [Dense; 2],
}

#[derive(Debug, Clone, Default)]
pub(super) struct ModulatedTape {
    input: Vec<f32>,
    normed: Vec<f32>,
    /// Scale, then shift, of each sample.
    modulation: Vec<f32>,
    modulated: Vec<f32>,
    before: Vec<f32>,
    hidden: Vec<f32>,
    branch: Vec<f32>,
    dhidden: Vec<f32>,
    dmodulated: Vec<f32>,
    dmodulation: Vec<f32>,
    dnormed: Vec<f32>,
    dcondition: Vec<f32>,
}

impl Modulated {
    pub fn new(width: usize, condition: usize) -> Result<Self> {
        let dense = |inputs, outputs| Dense::new(inputs, outputs, Activation::Identity);
        Ok(Self {
            norm: LayerNorm::new(width, 1e-5)?,
            condition: dense(condition, 2 * width)?,
            feed: [dense(width, width)?, dense(width, width)?],
        })
    }

    fn counts(&self) -> [usize; 4] {
        let [inner, outer] = self.feed.map(|layer| layer.parameters());
        [self.norm.parameters(), self.condition.parameters(), inner, outer]
    }

    pub fn parameters(&self) -> usize {
        self.counts().iter().sum()
    }

    pub fn initialise(&self, random: &mut Random, parameters: &mut [f32]) {
        let [norm, condition, inner, outer] = split_mut(parameters, self.counts());
        initialise_norm(norm);
        condition.fill(0.0);
        initialise_dense(&self.feed[0], random, inner);
        initialise_dense(&self.feed[1], random, outer);
    }

    /// Computes the block in place of `x`, `[batch, width]`.
    pub fn forward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        condition: &[f32],
        x: &mut [f32],
        tape: &mut ModulatedTape,
    ) {
        let [of_norm, of_condition, inner, outer] = split(parameters, self.counts());
        let ModulatedTape { input, normed, modulation, modulated, before, hidden, branch, .. } = tape;
        for values in [&mut *input, normed, modulated, before, hidden, branch] {
            values.resize(x.len(), 0.0);
        }
        input.copy_from_slice(x);
        self.norm.forward(of_norm, x, normed);
        modulation.resize(2 * x.len(), 0.0);
        self.condition.forward(compute, of_condition, condition, modulation);
        let width = self.norm.size();
        let rows = modulated.chunks_exact_mut(width).zip(normed.chunks_exact(width));
        for ((modulated, normed), modulation) in rows.zip(modulation.chunks_exact(2 * width)) {
            let (scale, shift) = modulation.split_at(width);
            for (((to, x), scale), shift) in modulated.iter_mut().zip(normed).zip(scale).zip(shift) {
                *to = x * (1.0 + scale) + shift;
            }
        }
        self.feed[0].forward(compute, inner, modulated, before);
        Gelu.forward(compute, before, hidden);
        self.feed[1].forward(compute, outer, hidden, branch);
        add(x, branch);
    }

    /// Computes the backward pass: `dx`, the gradient of the output, becomes that of the input. Adds to `gradients` and to the gradient
    /// of the condition.
    pub fn backward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        (condition, dcondition): (&[f32], &mut [f32]),
        dx: &mut [f32],
        tape: &mut ModulatedTape,
        gradients: &mut [f32],
    ) {
        let [of_norm, of_condition, inner, outer] = split(parameters, self.counts());
        let [dnorm, dof_condition, dinner, douter] = split_mut(gradients, self.counts());
        let ModulatedTape { dhidden, dmodulated, dmodulation, dnormed, .. } = tape;
        for values in [&mut *dhidden, dmodulated, dnormed] {
            values.resize(dx.len(), 0.0);
        }
        dmodulation.resize(2 * dx.len(), 0.0);
        tape.branch.copy_from_slice(dx);
        let ends = [&tape.hidden[..], &tape.input];
        self.feed[1].backward(compute, outer, ends, &mut tape.branch, Some(douter), Some(dhidden));
        Gelu.backward(compute.isa(), &tape.before, dhidden);
        let ends = [&tape.modulated[..], &tape.before];
        self.feed[0].backward(compute, inner, ends, dhidden, Some(dinner), Some(dmodulated));
        let width = self.norm.size();
        for (sample, down) in dmodulated.chunks_exact(width).enumerate() {
            let normed = &tape.normed[sample * width..];
            let (scale, _) = tape.modulation[sample * 2 * width..].split_at(width);
            let (dscale, dshift) = dmodulation[sample * 2 * width..][..2 * width].split_at_mut(width);
            let dnormed = &mut dnormed[sample * width..];
            for at in 0..width {
                dscale[at] = down[at] * normed[at];
                dshift[at] = down[at];
                dnormed[at] = down[at] * (1.0 + scale[at]);
            }
        }
        tape.dcondition.resize(condition.len(), 0.0);
        self.condition.backward(
            compute,
            of_condition,
            [condition, &tape.modulation],
            dmodulation,
            Some(dof_condition),
            Some(&mut tape.dcondition),
        );
        add(dcondition, &tape.dcondition);
        // The gradient of the branch is no longer needed.
        let down = &mut tape.branch;
        self.norm.backward(of_norm, &tape.input, dnormed, Some(dnorm), Some(down));
        add(dx, down);
    }
}
