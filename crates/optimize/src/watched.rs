//! A network whose inner tensors can be seen.

use opendr_engine::{Device, Result};
use opendr_inference::recording::Recording;
use opendr_inference::{Session, TensorView};
use opendr_onnx::bytes_from_model;
use opendr_onnx::proto::{
    DataType, GraphProto, ModelProto, TensorType, TypeProto, TypeValue, ValueInfoProto,
};

/// A session that gives out inner tensors.
pub struct Watched {
    session: Session,
    /// Where each tensor that is watched lies among the outputs.
    places: Vec<usize>,
}

impl Watched {
    /// Opens `model` with `graph` in its place and the float tensors `names` as outputs.
    ///
    /// # Errors
    /// As [`Session::open`].
    pub fn open(model: &ModelProto, graph: &GraphProto, names: &[String], device: Device) -> Result<Self> {
        let mut graph = graph.clone();
        for name in names {
            if !graph.output.iter().any(|output| output.name == *name) {
                let tensor = TensorType { elem_type: DataType::Float as i32, shape: None };
                let value = Some(TypeValue::Tensor(tensor));
                graph.output.push(ValueInfoProto {
                    name: name.clone(),
                    r#type: Some(TypeProto { value, ..TypeProto::default() }),
                    ..ValueInfoProto::default()
                });
            }
        }
        let model = ModelProto { graph: Some(graph), ..model.clone() };
        let session = Session::open(&bytes_from_model(&model), device)?;
        let places = names.iter().map(|name| session.output_index(name)).collect::<Result<_>>()?;
        Ok(Self { session, places })
    }

    /// Runs on what was recorded; `see` gets the number of each tensor among `names`, and its elements.
    ///
    /// # Errors
    /// As [`Session::run`].
    pub fn run(&self, recording: &Recording, mut see: impl FnMut(usize, &[f32])) -> Result<()> {
        let inputs =
            recording.given.iter().map(|tensor| tensor.view()).collect::<Result<Vec<TensorView<'_>>>>()?;
        self.session.run(&inputs, |outputs| {
            for (at, place) in self.places.iter().enumerate() {
                if let Some(output) = outputs.get(*place) {
                    see(at, output.values()?);
                }
            }
            Ok(())
        })
    }
}
