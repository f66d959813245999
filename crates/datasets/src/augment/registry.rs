//! The list of augmentations.

use opendr_engine::{Error, Result};

use crate::augment::*;

/// Returns all augmentations.
pub const fn augmentations() -> &'static [AugmentEntry] {
    const {
        &[
            AugmentEntry::of::<Flip>(),
            AugmentEntry::of::<CentreCrop>(),
            AugmentEntry::of::<RandomCrop>(),
            AugmentEntry::of::<RandomResizedCrop>(),
            AugmentEntry::of::<IouCrop>(),
            AugmentEntry::of::<Resize>(),
            AugmentEntry::of::<RandomScale>(),
            AugmentEntry::of::<Letterbox>(),
            AugmentEntry::of::<Rotate>(),
            AugmentEntry::of::<Affine>(),
            AugmentEntry::of::<Mosaic>(),
            AugmentEntry::of::<MixUp>(),
            AugmentEntry::of::<Colour>(),
            AugmentEntry::of::<Grey>(),
            AugmentEntry::of::<Blur>(),
            AugmentEntry::of::<PixelNoise>(),
            AugmentEntry::of::<CutOut>(),
            AugmentEntry::of::<CloudRotate>(),
            AugmentEntry::of::<CloudScale>(),
            AugmentEntry::of::<CloudFlip>(),
            AugmentEntry::of::<DropPoints>(),
            AugmentEntry::of::<JitterPoints>(),
            AugmentEntry::of::<PasteObjects>(),
            AugmentEntry::of::<AudioShift>(),
            AugmentEntry::of::<AudioNoise>(),
            AugmentEntry::of::<AudioGain>(),
            AugmentEntry::of::<SpecAugment>(),
            AugmentEntry::of::<SeriesJitter>(),
            AugmentEntry::of::<SeriesScale>(),
        ]
    }
}

/// Returns the augmentation `name`.
///
/// # Errors
/// `NotFound`, with the list of names.
pub fn find_augmentation(name: &str) -> Result<&'static AugmentEntry> {
    augmentations().iter().find(|entry| entry.name == name).ok_or_else(|| {
        let names: Vec<_> = augmentations().iter().map(|entry| entry.name).collect();
        Error::not_found(format!("no augmentation {name:?}; choose one of {}", names.join(", ")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_lists_every_augmentation() {
        let Ok(folder) = std::env::var("CARGO_MANIFEST_DIR") else { return };
        let page = std::fs::read_to_string(folder + "/../../docs/augmentation.md").unwrap();
        for entry in augmentations() {
            let row = format!("| `{}` | {} | ", entry.name, entry.about);
            assert!(page.contains(&row), "docs/augmentation.md lacks {row:?}");
        }
    }
}
