//! Rewrites of finished graphs. Each leaves the results as they were, up to rounding.

mod conv_affine;
mod dead_nodes;
mod identity;
mod pad;
mod rewriter;

pub use conv_affine::fold_affine_into_conv;
pub use dead_nodes::remove_dead_nodes;
pub use identity::remove_identities;
pub use pad::fold_padding;
pub use rewriter::Rewriter;

use super::proto::GraphProto;

/// All rewrites, in an order in which one prepares the next.
pub fn simplify(graph: &mut GraphProto) {
    remove_identities(graph);
    fold_padding(graph);
    fold_affine_into_conv(graph);
    remove_dead_nodes(graph);
}
