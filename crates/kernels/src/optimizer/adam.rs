use crate::compute::Compute;
use crate::isa::for_every_isa;
use crate::lanes::Lanes;

/// Adam (Kingma and Ba, 2015) and AdamW (Loshchilov and Hutter, 2019), with PyTorch's bias correction and position of
/// epsilon: `p -= rate / (1 - beta1^t) m / (sqrt(v) / sqrt(1 - beta2^t) + epsilon)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Adam {
    /// Options, which stay the same during a training.
    pub options: AdamOptions,
    /// Number of steps so far; with the moments, part of a checkpoint.
    pub steps: u64,
    /// Running means of the gradients.
    pub first: Vec<f32>,
    /// Running means of their squares.
    pub second: Vec<f32>,
}

/// Options of [`Adam`]; the defaults are PyTorch's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdamOptions {
    /// Decay rates of the means of gradients and of squares, each in [0, 1).
    pub betas: [f64; 2],
    /// Term in the denominator that keeps a step finite where gradients vanish.
    pub epsilon: f32,
    /// Weight decay.
    pub weight_decay: WeightDecay,
}

/// Weight decay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WeightDecay {
    /// No weight decay.
    None,
    /// Added to the gradient, times the parameter, as in PyTorch's `Adam`.
    L2(f32),
    /// Subtracted from the parameter, times the parameter and the learning rate: `AdamW`.
    Decoupled(f32),
}

impl Default for AdamOptions {
    fn default() -> Self {
        Self { betas: [0.9, 0.999], epsilon: 1e-8, weight_decay: WeightDecay::None }
    }
}

/// Number of parameters that one thread updates at a time.
const PIECE: usize = 1 << 14;

impl Adam {
    /// Creates an optimiser of this many parameters.
    pub fn new(parameters: usize, options: AdamOptions) -> Self {
        Self { options, steps: 0, first: vec![0.0; parameters], second: vec![0.0; parameters] }
    }

    /// Takes one step at learning rate `rate`.
    ///
    /// # Panics
    /// When the number of parameters or gradients differs from the optimiser's.
    pub fn step(&mut self, compute: &Compute, rate: f32, parameters: &mut [f32], gradients: &[f32]) {
        let count = parameters.len();
        let lengths = [gradients.len(), self.first.len(), self.second.len()];
        assert_eq!(lengths, [count; 3], "`parameters` and `gradients` must have the length of the moments");
        self.steps += 1;
        let update = self.options.update(rate, self.steps);
        let pieces = Pieces { parameters, first: &mut self.first, second: &mut self.second };
        pieces.run(compute, gradients, update);
    }
}

impl AdamOptions {
    fn update(&self, rate: f32, step: u64) -> Update {
        let power = i32::try_from(step).unwrap_or(i32::MAX);
        let [first, second] = self.betas.map(|beta| 1.0 - beta.powi(power));
        let (added, kept) = match self.weight_decay {
            WeightDecay::None => (0.0, 1.0),
            WeightDecay::L2(decay) => (decay, 1.0),
            WeightDecay::Decoupled(decay) => (0.0, 1.0 - rate * decay),
        };
        Update {
            kept_moments: self.betas.map(|beta| beta as f32),
            added_moments: self.betas.map(|beta| (1.0 - beta) as f32),
            rate: (f64::from(rate) / first) as f32,
            scale: (1.0 / second.sqrt()) as f32,
            epsilon: self.epsilon,
            added,
            kept,
        }
    }
}

/// Coefficients of one step.
#[derive(Clone, Copy)]
struct Update {
    kept_moments: [f32; 2],
    added_moments: [f32; 2],
    rate: f32,
    scale: f32,
    epsilon: f32,
    added: f32,
    kept: f32,
}

struct Pieces<'a> {
    parameters: &'a mut [f32],
    first: &'a mut [f32],
    second: &'a mut [f32],
}

impl Pieces<'_> {
    fn run(self, compute: &Compute, gradients: &[f32], update: Update) {
        use crate::pool::Pieces as Cut;
        let isa = compute.isa();
        let count = gradients.len().div_ceil(PIECE);
        let parameters = Cut::new(self.parameters, PIECE);
        let (first, second) = (Cut::new(self.first, PIECE), Cut::new(self.second, PIECE));
        compute.pool().run(count, |index| {
            let from = index * PIECE;
            let gradients = &gradients[from..gradients.len().min(from + PIECE)];
            // SAFETY: each number comes once, and all four slices have equal lengths, hence equal pieces.
            unsafe {
                let [p, m, v] = [parameters.get(index), first.get(index), second.get(index)];
                let moments = [m.as_mut_ptr(), v.as_mut_ptr()];
                dispatch(isa, p.as_mut_ptr(), moments, gradients.as_ptr(), gradients.len(), &update);
            }
        });
    }
}

for_every_isa!(
    fn dispatch = update_all(
        parameters: *mut f32, moments: [*mut f32; 2], gradients: *const f32, length: usize, update: &Update,
    )
);

#[inline(always)]
unsafe fn update_all<V: Lanes>(
    parameters: *mut f32,
    [first, second]: [*mut f32; 2],
    gradients: *const f32,
    length: usize,
    update: &Update,
) {
    let whole = length / V::WIDTH * V::WIDTH;
    // SAFETY: all four have `length` numbers; whole registers lie within, the rest is counted.
    unsafe {
        for i in (0..whole).step_by(V::WIDTH) {
            let (p, m) = (V::load(parameters.add(i)), V::load(first.add(i)));
            let (v, g) = (V::load(second.add(i)), V::load(gradients.add(i)));
            let [p, m, v] = update_lanes(p, [m, v], g, update);
            p.store(parameters.add(i));
            m.store(first.add(i));
            v.store(second.add(i));
        }
        let rest = length - whole;
        if rest > 0 {
            let p = V::load_some(parameters.add(whole), rest);
            let m = V::load_some(first.add(whole), rest);
            let v = V::load_some(second.add(whole), rest);
            let g = V::load_some(gradients.add(whole), rest);
            let [p, m, v] = update_lanes(p, [m, v], g, update);
            p.store_some(parameters.add(whole), rest);
            m.store_some(first.add(whole), rest);
            v.store_some(second.add(whole), rest);
        }
    }
}

#[inline(always)]
unsafe fn update_lanes<V: Lanes>(p: V, [m, v]: [V; 2], g: V, update: &Update) -> [V; 3] {
    let ([keep_m, keep_v], [add_m, add_v]) = (update.kept_moments, update.added_moments);
    // SAFETY: the contract of `Lanes`, passed on.
    unsafe {
        let g = if update.added == 0.0 { g } else { p.mul_add(V::splat(update.added), g) };
        let m = m.mul(V::splat(keep_m)).add(g.mul(V::splat(add_m)));
        let v = v.mul(V::splat(keep_v)).add(g.mul(g).mul(V::splat(add_v)));
        let scale = v.sqrt().mul(V::splat(update.scale)).add(V::splat(update.epsilon));
        let p = p.mul(V::splat(update.kept));
        [p.sub(m.mul(V::splat(update.rate)).div(scale)), m, v]
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{Isa, WorkerPool};

    /// PyTorch's rule in double precision.
    fn reference(options: AdamOptions, rate: f64, p: &mut f64, state: &mut [f64; 2], g: f64, t: i32) {
        let [beta1, beta2] = options.betas;
        let mut g = g;
        match options.weight_decay {
            WeightDecay::None => (),
            WeightDecay::L2(decay) => g += f64::from(decay) * *p,
            WeightDecay::Decoupled(decay) => *p *= 1.0 - rate * f64::from(decay),
        }
        state[0] = beta1 * state[0] + (1.0 - beta1) * g;
        state[1] = beta2 * state[1] + (1.0 - beta2) * g * g;
        let denominator = state[1].sqrt() / (1.0 - beta2.powi(t)).sqrt() + f64::from(options.epsilon);
        *p -= rate / (1.0 - beta1.powi(t)) * state[0] / denominator;
    }

    #[test]
    fn equals_the_rule_in_double_precision() {
        let count = 37;
        for decay in [WeightDecay::None, WeightDecay::L2(0.1), WeightDecay::Decoupled(0.1)] {
            let options = AdamOptions { weight_decay: decay, epsilon: 1e-5, ..AdamOptions::default() };
            for isa in Isa::available() {
                let compute = Compute::new(isa, Arc::new(WorkerPool::new(1)));
                let mut adam = Adam::new(count, options);
                let mut p: Vec<f32> = (0..count).map(|i| i as f32 * 0.1 - 2.0).collect();
                let mut exact: Vec<f64> = p.iter().map(|&p| f64::from(p)).collect();
                let mut state = vec![[0.0; 2]; count];
                for t in 1..=50 {
                    let g: Vec<f32> = (0..count).map(|i| ((i + 1) as f32 * t as f32).sin()).collect();
                    adam.step(&compute, 0.01, &mut p, &g);
                    for i in 0..count {
                        reference(options, 0.01, &mut exact[i], &mut state[i], f64::from(g[i]), t);
                    }
                }
                // Rounding errors of fifty steps, 2^-23 each, a few times per step.
                for (ours, exact) in p.iter().zip(&exact) {
                    assert!((f64::from(*ours) - exact).abs() < 1e-5, "{ours} {exact} {decay:?} {isa}");
                }
            }
        }
    }

    #[test]
    fn threads_do_not_change_a_bit() {
        let count = 3 * PIECE + 5;
        let gradients: Vec<f32> = (0..count).map(|i| (i as f32).sin()).collect();
        let run = |threads| {
            let (compute, mut adam) =
                (Compute::with_threads(threads), Adam::new(count, AdamOptions::default()));
            let mut p = vec![1.0; count];
            (0..3).for_each(|_| adam.step(&compute, 1e-3, &mut p, &gradients));
            (p, adam)
        };
        assert_eq!(run(1), run(3));
    }
}
