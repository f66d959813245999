//! Success rates of hand-written controllers in the corridor, in 500 fixed worlds:
//! `cargo run --release -p opendr-rl --example corridor_baselines [ID [WORLDS]]`.

use opendr_engine::environment::{Environment as _, ResetOptions};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result};
use opendr_rl::{EvaluationProtocol, evaluate_controller};
use opendr_simulation::uav_corridor::{
    CorridorController, ObservationController, PotentialField, ReactiveController, StraightController,
    UavDepthCorridor, UavDepthCorridorParams,
};
use opendr_simulation::{RegisteredEnvironment as _, Registry, make};

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let id = arguments.next().unwrap_or_else(|| "UavDepthCorridor-v1".to_owned());
    let episodes = arguments.next().map_or(Ok(500), |text| text.parse());
    let episodes =
        episodes.map_err(|_| Error::invalid_param("the number of worlds is not a whole number"))?;
    let protocol = EvaluationProtocol { episodes, ..EvaluationProtocol::default() };
    println!("{id}: {} of {episodes} worlds are passable", passable(&id, &protocol)?);
    fly("straight", StraightController, &id, &protocol)?;
    fly("by hand", ReactiveController::default(), &id, &protocol)?;
    fly("potential field", PotentialField::default(), &id, &protocol)
}

fn passable(id: &str, protocol: &EvaluationProtocol) -> Result<usize> {
    let fields = Registry::builtin().get(id)?.fields();
    let defaults = fields.iter().map(|field| (field.name.to_owned(), field.default.value())).collect();
    let mut corridor = UavDepthCorridor::new(&UavDepthCorridorParams::from_map(&defaults)?)?;
    let mut seen = vec![0.0; corridor.spec().observation.len()];
    let mut count = 0;
    for world in 0..protocol.episodes {
        corridor.reset(Some(protocol.first_seed + world), &ResetOptions::new(), &mut seen)?;
        count += usize::from(corridor.world().is_passable());
    }
    Ok(count)
}

fn fly(
    name: &str,
    controller: impl CorridorController,
    id: &str,
    protocol: &EvaluationProtocol,
) -> Result<()> {
    let mut environment = make(id)?;
    let mut controller = ObservationController::new(controller, environment.spec().observation.clone());
    let report =
        evaluate_controller(&mut controller, &mut *environment, protocol, &|step| step.info.success())?;
    let Some(success) = report.success else { return Ok(()) };
    let [rate, low, high] =
        [success.rate, success.interval[0], success.interval[1]].map(|share| 100.0 * share);
    println!(
        "{name}: success {rate:.1} % (95 %: {low:.1} to {high:.1}), {:.1} steps a flight, {:.2} s",
        report.mean_length, report.seconds
    );
    Ok(())
}
