//! Where a large picture shows what is looked for, and where not.

mod high_resolution_patches;

#[cfg(feature = "training")]
pub use high_resolution_patches::HighResolutionPatchesFitParams;
pub use high_resolution_patches::{
    HighResolutionPatches, HighResolutionPatchesParams, HighResolutionPatchesTargets, PatchArchitecture,
};
