//! Detector from an ONNX file that another tool exported: YOLOv5 to v12, YOLO26, YOLOX, RT-DETR, D-FINE, DETR, torchvision and others.
//!
//! The layout of inputs and outputs is recognised from names, shapes, metadata and operators. A parameter overrides it; what is
//! neither recognised nor given is an error that names the parameter. `docs/bring_your_own.md` lists the conventions.

mod convention;
mod decode;
mod masks;
mod oriented;
mod params;
mod roles;
mod settled;
#[cfg(test)]
mod tests;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::TensorView;
use opendr_perception_common::boxes_from_candidates::{box_from_candidate, boxes_from_candidates};
use opendr_perception_common::exported_network::{
    ExportedNetwork, Facts, ImageInput, NetworkKind, Selection,
};
use opendr_perception_common::suppression::Suppression;
use opendr_vision::InputGeometry;

pub use params::{
    BoxAngle, BoxFormat, BoxUnit, ImportedDetectorParams, MaskOutput, Objectness, OutputLayout, RowOrder,
    ScoreFormat,
};

use decode::{Decoder, Scratch};
use roles::Roles;

/// A loaded detector of another tool.
pub struct ImportedDetector {
    params: ImportedDetectorParams,
    classes: Classes,
    network: ExportedNetwork,
    decoder: Decoder,
    scratch: Pool<Scratch>,
}

impl Learner for ImportedDetector {
    const SPEC: Spec = Spec::new("detector", Task::ObjectDetection2d)
        .class("ImportedDetectorLearner")
        .about(
            "Runs your own detector, exported to ONNX by another tool; recognises the layout of its outputs.",
        )
        .recognises_network(|onnx| NetworkKind::Detector.recognises(onnx));
    type Params = ImportedDetectorParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, mut params: ImportedDetectorParams, device: Device) -> Result<Self> {
        let (session, facts) = Facts::open(model, device)?;
        let image = ImageInput::find(&facts, params.input.side())?;
        let classes = facts.classes(model);
        let convention = settled::settle(&mut params, convention::recognise(&facts, image.size)?, &facts)?;
        let roles = Roles::find(convention.layout, &facts, classes.len())?;
        let network = ExportedNetwork::new(session, image, &convention.input)?;
        let prototypes = match convention.masks {
            MaskOutput::Prototypes => facts.prototypes(),
            MaskOutput::Auto | MaskOutput::Absent => None,
        };
        let decoder = Decoder { convention, roles, classes: classes.len(), prototypes, size: image.size };
        Ok(Self { params, classes, network, decoder, scratch: Pool::default() })
    }

    fn params(&self) -> &ImportedDetectorParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ImportedDetectorParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, boxes: &mut BoundingBoxList) -> Result<()> {
        let scratch = &mut *self.scratch.take();
        let ImportedDetectorParams { threshold, max_detections, multi_label, suppression, .. } = self.params;
        let suppression = Suppression {
            kind: suppression,
            iou_threshold: self.iou_threshold(),
            threshold,
            max_boxes: max_detections,
        };
        self.network.run(image.view(), |outputs, geometry| {
            if outputs.is_empty() {
                return Err(Error::format("the network has no outputs"));
            }
            self.decoder.run(outputs, Selection { threshold, multi_label }, scratch)?;
            let Some(rows) = self.decoder.oriented(outputs)? else {
                suppression.run(&mut scratch.candidates, &mut scratch.marks);
                return self.write(boxes, outputs, geometry, scratch);
            };
            let Scratch { candidates, shapes, marks, .. } = &mut *scratch;
            oriented::suppress(candidates, &rows, suppression.iou_threshold, max_detections, shapes, marks);
            boxes.boxes.clear();
            boxes.classes.clone_from(&self.classes);
            boxes.boxes.extend(candidates.iter().filter_map(|candidate| {
                oriented::box_from_oriented(candidate, oriented::angle(&rows, candidate), geometry)
            }));
            Ok(())
        })
    }
}

impl ImportedDetector {
    /// Writes the candidates that are left as boxes, with masks where the network has them.
    fn write(
        &self,
        boxes: &mut BoundingBoxList,
        outputs: &[TensorView<'_>],
        geometry: &InputGeometry,
        Scratch { candidates, masks, .. }: &mut Scratch,
    ) -> Result<()> {
        let Some((prototypes, rows)) = self.decoder.masks(outputs)? else {
            boxes_from_candidates(boxes, candidates, geometry, &self.classes);
            return Ok(());
        };
        let image = geometry.image_size.map(|side| side as usize);
        let content = prototypes.content(geometry, image, self.decoder.size);
        let first = rows.fields() - prototypes.channels();
        boxes.boxes.clear();
        boxes.classes.clone_from(&self.classes);
        for candidate in candidates.iter() {
            let Some(mut found) = box_from_candidate(candidate, geometry) else { continue };
            let coefficient = |channel| rows.at(candidate.index as usize, first + channel);
            let mask = prototypes.mask(coefficient, content, found.corners(), image, masks)?;
            found.segment = Some(Box::new(mask));
            boxes.boxes.push(found);
        }
        Ok(())
    }

    /// Returns the threshold of the suppression; 1 where the network has suppressed already, as no IoU exceeds it.
    fn iou_threshold(&self) -> f32 {
        match self.params.layout {
            OutputLayout::Detections | OutputLayout::Queries => 1.0,
            OutputLayout::Auto | OutputLayout::Candidates | OutputLayout::GridCandidates => {
                self.params.iou_threshold
            }
        }
    }
}
