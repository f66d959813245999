//! Scripted teachers of `PlanarPush-v1` and `PlanarPeg-v1`.

use opendr_engine::Result;
use opendr_engine::environment::{Controller, Space};
use opendr_rl::prior::{BoxedController, Prior, unread_space};
use opendr_simulation::planar_peg::PegTeacher;
use opendr_simulation::planar_push::PushTeacher;

pub(super) fn priors() -> Vec<Prior> {
    vec![
        teacher::<PushTeacher>("planar-push-teacher", PushTeacher::space()).about(
            "pushes the T to its goal by planned strokes, around it left or right at random, in PlanarPush-v1",
        ),
        teacher::<PegTeacher>("planar-peg-teacher", PegTeacher::space()).about(
            "grasps the peg and inserts it, past the post left or right at random, with rests, in PlanarPeg-v1",
        ),
    ]
}

/// Returns the prior of a teacher that reads observations of a space.
fn teacher<C: Controller + Default + Send + 'static>(name: &'static str, own: Space) -> Prior {
    Prior::new(name, 1, move |space: &Space| -> Result<BoxedController> {
        if *space == own { Ok(Box::<C>::default()) } else { Err(unread_space(name, space)) }
    })
}

#[cfg(test)]
mod tests {
    use opendr_rl::{EvaluationProtocol, evaluate_controller};
    use opendr_simulation::make;

    use super::*;

    #[test]
    fn the_teachers_succeed() {
        for (prior, id) in priors().iter().zip(["PlanarPush-v1", "PlanarPeg-v1"]) {
            let mut environment = make(id).unwrap();
            let mut teacher = prior.controller(&environment.spec().observation).unwrap();
            let protocol = EvaluationProtocol { episodes: 50, ..EvaluationProtocol::default() };
            let success = |step: &opendr_engine::environment::Step| step.info.success();
            let report = evaluate_controller(&mut *teacher, &mut *environment, &protocol, &success).unwrap();
            assert!(report.success.unwrap().rate >= 0.96, "{id}: {:?}", report.success);
            assert!(prior.controller(&make("CartPole-v1").unwrap().spec().observation).is_err());
        }
    }
}
