//! Recording of the tensors of all sessions of a thread, so that a network can be calibrated or inspected without
//! changes to the learner.
//!
//! Call [`start`] (inputs) or [`start_with_outputs`], run the learner on the same thread, and [`take`] the recorded runs.
//! Nothing is recorded otherwise.

use std::cell::RefCell;

use opendr_engine::Result;

use crate::tensor::{ElementType, TensorData, TensorInfo, TensorView};

/// A recorded run of a session.
#[derive(Debug, Clone)]
pub struct Recording {
    /// Declared inputs of the session.
    pub inputs: Vec<TensorInfo>,
    /// Declared outputs of the session.
    pub outputs: Vec<TensorInfo>,
    /// Input tensors of the run, in the order of the inputs.
    pub tensors: Vec<RecordedTensor>,
    /// Output tensors of the run, in the order of the outputs; empty after [`start`], and where the run failed.
    pub output_tensors: Vec<RecordedTensor>,
}

/// A copy of a tensor.
#[derive(Debug, Clone)]
pub struct RecordedTensor {
    shape: Vec<usize>,
    elements: Elements,
}

#[derive(Debug, Clone)]
enum Elements {
    F32(Vec<f32>),
    I32(Vec<i32>),
    I64(Vec<i64>),
    U8(Vec<u8>),
    I8(Vec<i8>),
    Bool(Vec<bool>),
}

/// The recording of a thread.
struct Record {
    runs: Vec<Recording>,
    with_outputs: bool,
}

thread_local! {
    static RECORD: RefCell<Option<Record>> = const { RefCell::new(None) };
}

/// Starts recording inputs on this thread; earlier recordings are dropped.
pub fn start() {
    RECORD.set(Some(Record { runs: Vec::new(), with_outputs: false }));
}

/// Starts recording inputs and outputs on this thread; earlier recordings are dropped.
pub fn start_with_outputs() {
    RECORD.set(Some(Record { runs: Vec::new(), with_outputs: true }));
}

/// Stops recording on this thread and returns the runs since it started, in order.
pub fn take() -> Vec<Recording> {
    RECORD.take().map(|record| record.runs).unwrap_or_default()
}

/// Adds a run; returns its index where its outputs are to be recorded, too.
pub(crate) fn add(
    inputs: &[TensorInfo],
    outputs: &[TensorInfo],
    tensors: &[TensorView<'_>],
) -> Option<usize> {
    RECORD.with_borrow_mut(|record| {
        let record = record.as_mut()?;
        record.runs.push(Recording {
            inputs: inputs.to_vec(),
            outputs: outputs.to_vec(),
            tensors: tensors.iter().map(RecordedTensor::from).collect(),
            output_tensors: Vec::new(),
        });
        record.with_outputs.then_some(record.runs.len() - 1)
    })
}

/// Adds the outputs of the run of that index.
pub(crate) fn add_outputs(run: usize, tensors: &[TensorView<'_>]) {
    RECORD.with_borrow_mut(|record| {
        if let Some(run) = record.as_mut().and_then(|record| record.runs.get_mut(run)) {
            run.output_tensors = tensors.iter().map(RecordedTensor::from).collect();
        }
    });
}

impl Recording {
    /// Returns the approximate memory use in bytes.
    pub fn bytes(&self) -> usize {
        let width = |info: &TensorInfo| match info.element_type {
            ElementType::I64 => 8,
            ElementType::F32 | ElementType::I32 => 4,
            _ => 1,
        };
        let elements = |tensor: &RecordedTensor| tensor.shape.iter().product::<usize>();
        self.inputs.iter().zip(&self.tensors).map(|(info, tensor)| width(info) * elements(tensor)).sum()
    }
}

impl From<&TensorView<'_>> for RecordedTensor {
    fn from(tensor: &TensorView<'_>) -> Self {
        let elements = match tensor.data() {
            TensorData::F32(data) => Elements::F32(data.to_vec()),
            TensorData::I32(data) => Elements::I32(data.to_vec()),
            TensorData::I64(data) => Elements::I64(data.to_vec()),
            TensorData::U8(data) => Elements::U8(data.to_vec()),
            TensorData::I8(data) => Elements::I8(data.to_vec()),
            TensorData::Bool(data) => Elements::Bool(data.to_vec()),
        };
        Self { shape: tensor.shape().to_vec(), elements }
    }
}

impl RecordedTensor {
    /// Returns a view of the tensor, as input of a session.
    ///
    /// # Errors
    /// None for a recorded tensor.
    pub fn view(&self) -> Result<TensorView<'_>> {
        match &self.elements {
            Elements::F32(data) => TensorView::new(&self.shape, data),
            Elements::I32(data) => TensorView::new(&self.shape, data),
            Elements::I64(data) => TensorView::new(&self.shape, data),
            Elements::U8(data) => TensorView::new(&self.shape, data),
            Elements::I8(data) => TensorView::new(&self.shape, data),
            Elements::Bool(data) => TensorView::new(&self.shape, data),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_given_between_start_and_take_is_kept() {
        let data = [1.0_f32, 2.0];
        let given = [TensorView::new(&[1, 2], &data).unwrap(), TensorView::new(&[2], &[3_i64, 4]).unwrap()];
        add(&[], &[], &given);
        assert!(take().is_empty());
        start();
        assert_eq!(add(&[], &[], &given), None);
        add(&[], &[], &given[..1]);
        let runs = take();
        assert!(runs.iter().all(|run| run.output_tensors.is_empty()));
        assert_eq!(runs.iter().map(|run| run.tensors.len()).collect::<Vec<_>>(), [2, 1]);
        let view = runs[0].tensors[0].view().unwrap();
        assert_eq!((view.shape(), view.values::<f32>().unwrap()), (&[1, 2][..], &data[..]));
        assert_eq!(runs[0].tensors[1].view().unwrap().values::<i64>().unwrap(), [3, 4]);
        add(&[], &[], &given);
        assert!(take().is_empty());
    }

    #[test]
    fn outputs_belong_to_their_run() {
        let given = [TensorView::new(&[1], &[1.0_f32]).unwrap()];
        start_with_outputs();
        // The second run is inside the sink of the first.
        let [outer, inner] = [(); 2].map(|()| add(&[], &[], &given).unwrap());
        add_outputs(inner, &given);
        add_outputs(outer, &[TensorView::new(&[2], &[5_i64, 6]).unwrap()]);
        let runs = take();
        assert_eq!(runs[0].output_tensors[0].view().unwrap().values::<i64>().unwrap(), [5, 6]);
        assert_eq!(runs[1].output_tensors[0].view().unwrap().values::<f32>().unwrap(), [1.0]);
        // A run that ends after the recording changes nothing.
        add_outputs(inner, &given);
        assert!(take().is_empty());
    }
}
