//! Classification of sequences of feature vectors.

mod co_trans_enc;

#[cfg(feature = "training")]
pub use co_trans_enc::CoTransEncFitParams;
pub use co_trans_enc::{CoTransEnc, CoTransEncParams, CoTransEncState};
