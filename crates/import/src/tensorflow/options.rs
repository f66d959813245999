//! What the caller may choose.

/// What the caller may choose. The defaults import a model as it is.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ImportOptions {
    /// Height and width of image inputs whose size the model leaves open. Without it they stay open.
    pub image_size: Option<(usize, usize)>,
    /// Outputs to keep, by name; all when empty. What only others need is left out of the graph.
    pub outputs: Vec<String>,
}
