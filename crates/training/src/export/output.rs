//! Outputs of a network.

use burn::backend::capture::TensorId;
use burn::tensor::Tensor;
use opendr_engine::Result;

use super::input::ElementKind;

/// A tensor of any rank and element type; or tuples (up to eight), arrays and vectors of them.
pub trait Outputs {
    /// Appends the ids of the tensors in the recording, in order.
    #[doc(hidden)]
    fn ids(self, ids: &mut Vec<TensorId>) -> Result<()>;
}

impl<const D: usize, K: ElementKind> Outputs for Tensor<D, K> {
    fn ids(self, ids: &mut Vec<TensorId>) -> Result<()> {
        ids.push(K::id(self)?);
        Ok(())
    }
}

impl<O: Outputs> Outputs for Vec<O> {
    fn ids(self, ids: &mut Vec<TensorId>) -> Result<()> {
        self.into_iter().try_for_each(|output| output.ids(ids))
    }
}

impl<O: Outputs, const N: usize> Outputs for [O; N] {
    fn ids(self, ids: &mut Vec<TensorId>) -> Result<()> {
        self.into_iter().try_for_each(|output| output.ids(ids))
    }
}

macro_rules! impl_outputs {
    ($($name:ident),+) => {
        #[allow(non_snake_case)]
        impl<$($name: Outputs),+> Outputs for ($($name,)+) {
            fn ids(self, ids: &mut Vec<TensorId>) -> Result<()> {
                let ($($name,)+) = self;
                $($name.ids(ids)?;)+
                Ok(())
            }
        }
    };
}

impl_outputs!(A);
impl_outputs!(A, B);
impl_outputs!(A, B, C);
impl_outputs!(A, B, C, D);
impl_outputs!(A, B, C, D, E);
impl_outputs!(A, B, C, D, E, F);
impl_outputs!(A, B, C, D, E, F, G);
impl_outputs!(A, B, C, D, E, F, G, H);
