//! Options of an import.

/// Options of an import. The defaults import a model unchanged.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ImportOptions {
    /// Height and width of image inputs whose size the model leaves open; `None` keeps them open.
    pub image_size: Option<(usize, usize)>,
    /// Names of the outputs to keep; all when empty. Nodes that no kept output needs are removed.
    pub outputs: Vec<String>,
}
