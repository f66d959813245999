//! Continual transformer encoder: the class of a sequence of feature vectors, updated with every vector.
//!
//! Hedegaard, Bakhtiarnia and Iosifidis, Continual Transformers: Redundancy-Free Attention for Online Inference, ICLR 2023. One
//! or two encoder layers attend to the last `sequence_len` vectors (tokens). The last layer computes the attention of the
//! newest token only (single-output attention); of two layers, the first updates the outputs of all tokens (retroactive
//! attention). Queries, keys and values of each token are computed once and kept.
//!
//! The positions of the tokens recur every `2 * sequence_len - 1` steps (recycling positional encoding), so a token keeps its
//! encoding while it is in the sequence. In training, each sequence begins at a position drawn at random.
//!
//! # Differences from the paper
//!
//! The paper updates sums of exponentials in its retroactive attention: it subtracts what leaves the sequence and adds what
//! enters. In 32-bit floats these sums lose all digits, or overflow, where the scores are large (over 500 steps of 64 tokens,
//! an error of 0.01 with a standard deviation of the scores of 4, and of 5 with 9). Here the weights are computed from the kept
//! queries and keys, with the maximum subtracted. For `n` tokens of `d` features this takes `2 n² d` multiplications beside the
//! `n d (3 d + 2 hidden_dims)` of the rest of a step with two layers, and the step equals the clip however long the stream.
//!
//! There is no warm-up: the first vector is repeated for the time before it, so the first vector already yields a prediction
//! (and takes `sequence_len` steps).

#[cfg(feature = "training")]
mod encoder_layer;
#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
#[cfg(feature = "training")]
mod positions;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

#[cfg(feature = "training")]
pub use fit::CoTransEncFitParams;
use opendr_engine::data::Timeseries;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;

use crate::model_checks::{check_finite, check_size};

/// Parameters of [`CoTransEnc`]. The sizes apply to the network that is trained; a loaded model has its own and refuses other
/// values.
#[derive(Debug, Clone, Params)]
pub struct CoTransEncParams {
    /// Number of encoder layers.
    #[param(default = 1, range = 1..=2)]
    pub num_layers: usize,
    /// Number of features of an input vector. None: that of the data set.
    #[param(range = 1..=65_536)]
    pub input_dims: Option<usize>,
    /// Number of features of a token, to which input vectors are projected; a multiple of `num_heads`. None: input vectors are
    /// tokens, without a projection.
    #[param(range = 1..=65_536)]
    pub token_dims: Option<usize>,
    /// Number of features between the two linear maps of a layer.
    #[param(default = 1024, range = 1..=65_536)]
    pub hidden_dims: usize,
    /// Number of vectors that a prediction covers.
    #[param(default = 64, range = 2..=100_000)]
    pub sequence_len: usize,
    /// Number of attention heads.
    #[param(default = 8, range = 1..=1024)]
    pub num_heads: usize,
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=10_000)]
    pub num_classes: Option<usize>,
    /// Whether the positional encoding is learnt; otherwise it consists of sines and cosines.
    #[param(default = false)]
    pub positional_encoding_learned: bool,
}

impl CoTransEncParams {
    /// Returns the number of features that are kept of a token of `dims` features: its key and value; with two layers also the
    /// token and its query.
    fn kept(&self, dims: usize) -> usize {
        dims * if self.num_layers == 1 { 2 } else { 4 }
    }

    /// Returns the number of different positions.
    fn positions(&self) -> usize {
        2 * self.sequence_len - 1
    }
}

/// A loaded continual transformer encoder.
pub struct CoTransEnc {
    params: CoTransEncParams,
    classes: Classes,
    session: Session,
    /// Number of features of an input vector.
    inputs: usize,
    /// Shape of the memory: tokens before the current one, and features that are kept of each.
    memory: [usize; 2],
}

/// State of a stream: what the network keeps of the last tokens, in a ring.
#[derive(Debug, Default)]
pub struct CoTransEncState {
    /// One row per token; empty before the first vector. The order does not matter: the encoding of positions is in the rows.
    memory: Vec<f32>,
    /// Row of the oldest token.
    oldest: usize,
    /// Position of the next token.
    position: usize,
    /// Row of the newest token.
    row: Vec<f32>,
    logits: Vec<f32>,
}

/// File of the network in every container. Inputs: `vector` `[1, features]`, `position` `[1]`, `memory` `[tokens, kept]`;
/// outputs: `logits` `[1, classes]`, `row` `[1, kept]`, the row of the new token.
const FILE: &str = "model.onnx";

impl Learner for CoTransEnc {
    const SPEC: Spec = Spec::new("co_trans_enc", Task::ActivityRecognition)
        .class("CoTransEncLearner")
        .about("A continual transformer encoder classifies a stream of feature vectors, updated with every vector; trainable.")
        .without_effect(&[
            ("network_head", "only classification is supported"),
            ("loss", "always cross-entropy"),
            ("drop_last", "an incomplete last batch is always dropped"),
            ("pin_memory", "page-locked memory is not used"),
        ]);
    type Params = CoTransEncParams;
    type Input<'a> = &'a Timeseries;
    type Target = Category;
    type State = CoTransEncState;

    fn load(model: &Model, params: CoTransEncParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([vector, position, memory], [logits, row]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} does not have three inputs and two outputs")));
        };
        let (&[Some(1), Some(inputs)], &[Some(1)], &[Some(tokens), Some(kept)], &[_, Some(classes)]) =
            (&vector.dims[..], &position.dims[..], &memory.dims[..], &logits.dims[..])
        else {
            return Err(Error::format(format!(
                "{FILE} takes {vector}, {position} and {memory} and returns {logits}; expected a network of one step"
            )));
        };
        if row.dims != [Some(1), Some(kept)] {
            return Err(Error::format(format!(
                "{FILE} returns {row} for the memory {memory}; the rows must be equally long"
            )));
        }
        check_size("input_dims", params.input_dims, inputs)?;
        check_size("num_classes", params.num_classes, classes)?;
        check_size("sequence_len", Some(params.sequence_len), tokens + 1)?;
        let wanted = params.kept(params.token_dims.unwrap_or(inputs));
        if kept != wanted {
            return Err(Error::invalid_param(format!(
                "{FILE} keeps {kept} features of a token, but num_layers and token_dims specify {wanted}; omit these parameters"
            )));
        }
        Ok(Self {
            classes: model.manifest().classes.clone(),
            memory: [tokens, kept],
            inputs,
            params,
            session,
        })
    }

    fn params(&self) -> &CoTransEncParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut CoTransEncParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    /// Processes one or more vectors of a series and writes the prediction after the last of them.
    fn infer_into(
        &self,
        state: &mut CoTransEncState,
        series: &Timeseries,
        category: &mut Category,
    ) -> Result<()> {
        let [time, features] = series.shape();
        if features != self.inputs {
            return Err(Error::invalid_input(format!(
                "the series has {time} vectors of {features} features, but the network takes vectors of {}; choose another model \
                 or transpose the series",
                self.inputs
            )));
        }
        check_finite(series)?;
        for vector in series.as_slice().chunks_exact(features) {
            if state.memory.is_empty() {
                state.memory.resize(self.memory.iter().product(), 0.0);
                for _ in 1..self.params.sequence_len {
                    self.step(state, vector)?;
                }
            }
            self.step(state, vector)?;
        }
        category_from_logits(category, &state.logits, &self.classes)
    }
}

impl CoTransEnc {
    /// Processes one vector.
    fn step(&self, state: &mut CoTransEncState, vector: &[f32]) -> Result<()> {
        let CoTransEncState { memory, oldest, position, row, logits } = state;
        let now = [*position as i64];
        let inputs = [
            TensorView::new(&[1, self.inputs], vector)?,
            TensorView::new(&[1], &now[..])?,
            TensorView::new(&self.memory, &memory[..])?,
        ];
        self.session.run(&inputs, |outputs| {
            let [scores, kept] = outputs else {
                return Err(Error::internal("the network did not return two outputs"));
            };
            logits.clear();
            logits.extend_from_slice(scores.values()?);
            row.clear();
            row.extend_from_slice(kept.values()?);
            Ok(())
        })?;
        let [tokens, kept] = self.memory;
        memory[*oldest * kept..][..kept].copy_from_slice(row);
        *oldest = (*oldest + 1) % tokens;
        *position = (*position + 1) % self.params.positions();
        Ok(())
    }
}
