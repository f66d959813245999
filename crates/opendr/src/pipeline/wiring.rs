//! Which answer goes into which port.

use opendr_engine::learner::{Output, Port};

/// Where a port's value comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Wire {
    /// An answer of an earlier stage.
    Answer { stage: usize, output: &'static str },
    /// The pipeline's own input of the port's name.
    Input,
}

/// The wires of a learner's ports behind stages that answer `answered`; what nobody answers becomes an input of the
/// pipeline.
pub(super) fn wires(ports: &[Port], answered: &[&'static [Output]], inputs: &mut Vec<Port>) -> Vec<Wire> {
    let wire = |port: &Port| {
        let newest = answered.iter().enumerate().rev().find_map(|(stage, outputs)| {
            let fits = |output: &&Output| output.value_type == port.value_type;
            // What begins a stream is the user's to give.
            let output = outputs.iter().find(fits).filter(|_| !port.init)?;
            Some(Wire::Answer { stage, output: output.name })
        });
        newest.unwrap_or_else(|| {
            if !inputs.iter().any(|input| input.name == port.name) {
                inputs.push(*port);
            }
            Wire::Input
        })
    };
    ports.iter().map(wire).collect()
}

#[cfg(test)]
mod tests {
    use opendr_engine::ValueType;

    use super::*;

    const fn port(name: &'static str, value_type: ValueType, init: bool) -> Port {
        Port { name, doc: "", value_type, optional: false, init }
    }

    const fn output(name: &'static str, value_type: ValueType) -> Output {
        Output { name, doc: "", value_type }
    }

    #[test]
    fn the_newest_answer_of_a_type_is_taken() {
        const DETECTOR: &[Output] = &[output("detections", ValueType::BoundingBoxList)];
        const FILTER: &[Output] =
            &[output("poses", ValueType::PoseList), output("kept", ValueType::BoundingBoxList)];
        let mut inputs = vec![port("image", ValueType::Image, false)];
        let ports = [
            port("image", ValueType::Image, false),
            port("boxes", ValueType::BoundingBoxList, false),
            port("first", ValueType::BoundingBoxList, true),
            port("depth", ValueType::Heatmap, false),
        ];
        let found = wires(&ports, &[DETECTOR, FILTER], &mut inputs);
        let answer = Wire::Answer { stage: 1, output: "kept" };
        assert_eq!(found, [Wire::Input, answer, Wire::Input, Wire::Input]);
        let names: Vec<_> = inputs.iter().map(|input| input.name).collect();
        assert_eq!(names, ["image", "first", "depth"]);
    }
}
