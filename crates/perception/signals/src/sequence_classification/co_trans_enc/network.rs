//! The trained network, for sequences and for single steps of a stream.

use burn::module::Module;
use burn::nn::{Linear, LinearConfig};
use burn::tensor::{Device, Int, Tensor};
use opendr_engine::{Error, Result};

use super::CoTransEncParams;
use super::encoder_layer::{EncoderLayer, Projected};
use super::positions::Positions;

/// Encoder with a classifier on the last token: sequences `[batch, tokens, inputs]` to logits `[batch, classes]`.
#[derive(Module, Debug)]
pub(super) struct CoTransEncNetwork {
    projection: Option<Linear>,
    positions: Positions,
    /// The first of two layers, which has outputs for all tokens.
    retroactive: Option<EncoderLayer>,
    /// The last layer, which has an output for the last token only.
    single_output: EncoderLayer,
    classifier: Linear,
}

impl CoTransEncNetwork {
    /// Returns a network with initial weights for vectors of `inputs` features.
    ///
    /// # Errors
    /// `InvalidParam` when the number of features of a token is no multiple of the number of heads.
    pub fn new(
        params: &CoTransEncParams,
        inputs: usize,
        classes: usize,
        dropout: f64,
        device: &Device,
    ) -> Result<Self> {
        let (dims, heads) = (params.token_dims.unwrap_or(inputs), params.num_heads);
        if !dims.is_multiple_of(heads) {
            let (name, remedy) = match params.token_dims {
                Some(_) => ("token_dims", ""),
                None => ("input_dims", "set token_dims to project the input, or "),
            };
            return Err(Error::invalid_param(format!(
                "{name} = {dims} is no multiple of num_heads = {heads}; {remedy}choose another number"
            )));
        }
        let layer = || EncoderLayer::new(dims, params.hidden_dims, heads, dropout, device);
        let shape = [params.positions(), dims];
        Ok(Self {
            projection: params.token_dims.map(|dims| LinearConfig::new(inputs, dims).init(device)),
            positions: Positions::new(shape, params.positional_encoding_learned, device),
            retroactive: (params.num_layers > 1).then(layer),
            single_output: layer(),
            classifier: LinearConfig::new(dims, classes).init(device),
        })
    }

    /// Returns logits `[batch, classes]` of sequences `[batch, tokens, inputs]`; the first tokens have the positions `first`,
    /// `[batch, 1]`.
    pub fn forward(&self, sequences: Tensor<3>, first: Tensor<2, Int>) -> Tensor<2> {
        let [_, count, _] = sequences.dims();
        let positions = self.positions.of_sequences(first, count);
        let tokens = self.tokens(sequences, positions);
        let tokens = match &self.retroactive {
            Some(layer) => layer.forward(tokens),
            None => tokens,
        };
        self.classify(self.single_output.last(tokens))
    }

    /// Returns logits `[1, classes]` of the sequence that ends with `vector`, `[1, inputs]`, at the position `[1]`, and the row
    /// `[1, kept]` of its token. `memory` has the rows of the tokens before, in any order, `[tokens - 1, kept]`.
    pub fn step(
        &self,
        vector: Tensor<2>,
        position: Tensor<1, Int>,
        memory: Tensor<2>,
    ) -> (Tensor<2>, Tensor<2>) {
        let token = self.tokens(vector.unsqueeze(), position.unsqueeze());
        let layer = self.retroactive.as_ref().unwrap_or(&self.single_output);
        let Projected { query, key, value } = layer.project(token.clone());
        let newest = match &self.retroactive {
            Some(_) => vec![key, value, query.clone(), token.clone()],
            None => vec![key, value],
        };
        let (parts, row) = (newest.len(), Tensor::cat(newest, 2));
        let [_, kept] = memory.dims();
        let rows = Tensor::cat(vec![memory.unsqueeze(), row.clone()], 1);
        let part = |at: usize| rows.clone().narrow(2, at * kept / parts, kept / parts);
        let (key, value) = (part(0), part(1));
        let last = match &self.retroactive {
            Some(layer) => {
                let all = layer.attend(part(3), Projected { query: part(2), key, value });
                self.single_output.last(all)
            }
            None => layer.attend(token, Projected { query, key, value }),
        };
        (self.classify(last), row.reshape([1, kept]))
    }

    /// Returns tokens `[batch, tokens, features]` of vectors `[batch, tokens, inputs]`.
    fn tokens(&self, vectors: Tensor<3>, positions: Tensor<2, Int>) -> Tensor<3> {
        let tokens = match &self.projection {
            Some(projection) => projection.forward(vectors),
            None => vectors,
        };
        tokens + self.positions.forward(positions)
    }

    fn classify(&self, last: Tensor<3>) -> Tensor<2> {
        let [batch, _, dims] = last.dims();
        self.classifier.forward(last.reshape([batch, dims]))
    }
}
