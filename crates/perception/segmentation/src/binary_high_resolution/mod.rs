//! Binary classification of the patches of a large image.

mod high_resolution_patches;

#[cfg(feature = "training")]
pub use high_resolution_patches::HighResolutionPatchesFitParams;
pub use high_resolution_patches::{
    HighResolutionPatches, HighResolutionPatchesParams, HighResolutionPatchesTargets, PatchArchitecture,
};
