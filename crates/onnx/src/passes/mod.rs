//! Rewriting passes for finished graphs. Each preserves the results, up to rounding.

mod constants;
mod conv_affine;
mod conv_factor;
mod dead_nodes;
mod half_weights;
mod hard_swish;
mod identity;
mod pad;
mod prelu;
mod rewriter;
mod split;
mod subgraph;
mod transposed_conv;

pub use constants::constants_to_initializers;
pub use conv_affine::fold_affine_into_conv;
pub use conv_factor::fold_factor_into_conv;
pub use dead_nodes::remove_dead_nodes;
pub use half_weights::weights_to_fp16;
pub use hard_swish::fuse_hard_swish;
pub use identity::remove_identities;
pub use pad::fold_padding;
pub use prelu::prelu_to_conv;
pub use rewriter::Rewriter;
pub use subgraph::reduce_to_outputs;
pub use transposed_conv::transposed_conv_to_conv;

use super::proto::GraphProto;

/// Runs all simplifications, in an order in which each prepares the next.
pub fn simplify(graph: &mut GraphProto) {
    remove_identities(graph);
    for rewrite in [fold_padding, fold_affine_into_conv, fuse_hard_swish, fold_factor_into_conv] {
        rewrite(graph);
        remove_dead_nodes(graph);
    }
}
