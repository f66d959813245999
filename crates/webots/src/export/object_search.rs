//! The search for objects: walls and furniture of the flat, the objects, and a robot that a controller places.

use opendr_engine::Result;
use opendr_simulation::object_search::{CELL, FloorPlan, ObjectSearch, ObjectSearchParams, SIDE};

use super::episode::Episode;
use super::node::Node;
use super::world::{Physics, World, cuboid, robot, shape};

/// Height of walls and furniture, and radius and height of the robot, m.
const WALL: f64 = 1.2;
const ROBOT: [f64; 2] = [0.2, 0.4];
/// Angle between two rays of the scanner, rad.
const RAY: f64 = 0.018;

pub(super) fn world(episode: &Episode) -> Result<World> {
    let environment = episode.environment::<ObjectSearch>()?;
    let params = episode.params::<ObjectSearchParams>()?;
    let physics = Physics { step_ms: 50.0, gravity: 9.81 };
    let side = SIDE as f64 * CELL;
    let mut world = World::new(episode, &physics, [-4.0, side / 2.0, 9.0], [0.0, 1.0, 0.0, 0.8]);
    let Some(plan) = environment.plan() else { return Ok(world) };
    let floor = Node::new("Plane").numbers("size", &[side, side]);
    let floor = Node::new("Solid")
        .numbers("translation", &[side / 2.0, side / 2.0, 0.0])
        .nodes("children", vec![shape(floor.clone(), [0.7, 0.68, 0.62])])
        .text("name", "floor")
        .node("boundingObject", floor);
    world = world.with(floor);
    for (number, [low, high]) in blocks(plan).into_iter().enumerate() {
        let size = [high[0] - low[0], high[1] - low[1], WALL];
        let middle = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, WALL / 2.0];
        let solid = Node::new("Solid")
            .numbers("translation", &middle)
            .nodes("children", vec![shape(cuboid(size), [0.85, 0.83, 0.8])])
            .text("name", &format!("block {number}"))
            .node("boundingObject", cuboid(size));
        world = world.with(solid);
    }
    for (number, [x, y]) in plan.objects().iter().enumerate() {
        let geometry = Node::new("Cylinder").number("radius", 0.06).number("height", 0.25);
        let object = Node::defined(&format!("OBJECT_{number}"), "Solid")
            .numbers("translation", &[*x, *y, 0.125])
            .nodes("children", vec![shape(geometry, [0.9, 0.4, 0.15])])
            .text("name", &format!("object {number}"));
        world = world.with(object);
    }
    let [x, y, yaw] = plan.start();
    let searcher = robot("searcher", devices(&params))
        .numbers("translation", &[x, y, 0.0])
        .numbers("rotation", &[0.0, 0.0, 1.0, yaw]);
    Ok(world.with(searcher))
}

fn devices(params: &ObjectSearchParams) -> Vec<Node> {
    let [radius, height] = ROBOT;
    let width = params.field_of_view.to_radians();
    let body = Node::new("Cylinder").number("radius", radius).number("height", height);
    let scanner = Node::new("Lidar")
        .numbers("translation", &[0.0, 0.0, height + 0.05])
        .text("name", "scan")
        .number("fieldOfView", width)
        .number("horizontalResolution", (width / RAY).ceil() + 1.0)
        .number("numberOfLayers", 1.0)
        .number("minRange", 0.01)
        .number("maxRange", params.range);
    vec![
        Node::new("Pose")
            .numbers("translation", &[0.0, 0.0, height / 2.0])
            .nodes("children", vec![shape(body, [0.25, 0.35, 0.6])]),
        scanner,
        Node::new("GPS").text("name", "position"),
        Node::new("InertialUnit").text("name", "orientation"),
    ]
}

/// Returns the walls and the furniture as rectangles (lowest and highest corner, m): the occupied cells of each row in runs, and equal
/// runs of neighbouring rows together.
fn blocks(plan: &FloorPlan) -> Vec<[[f64; 2]; 2]> {
    let occupied =
        |column: usize, row: usize| plan.is_occupied([column, row].map(|at| (at as f64 + 0.5) * CELL));
    // Runs of columns that reach down to the row before, with their first row.
    let mut open: Vec<([usize; 2], usize)> = Vec::new();
    let mut blocks = Vec::new();
    for row in 0..=SIDE {
        let mut runs: Vec<[usize; 2]> = Vec::new();
        for column in (0..SIDE).filter(|column| row < SIDE && occupied(*column, row)) {
            match runs.last_mut() {
                Some(run) if run[1] == column => run[1] += 1,
                _ => runs.push([column, column + 1]),
            }
        }
        open.retain(|(run, first)| {
            let goes_on = runs.contains(run);
            if !goes_on {
                blocks
                    .push([[run[0], *first], [run[1], row]].map(|corner| corner.map(|at| at as f64 * CELL)));
            }
            goes_on
        });
        for run in runs {
            if !open.iter().any(|(other, _)| *other == run) {
                open.push((run, row));
            }
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use opendr_engine::Random;

    use super::*;

    #[test]
    fn blocks_cover_what_is_occupied_and_nothing_else() {
        let plan = FloorPlan::generate(&mut Random::new(5), &ObjectSearchParams::default());
        let blocks = blocks(&plan);
        assert!(blocks.len() < 400, "{}", blocks.len());
        for row in 0..SIDE {
            for column in 0..SIDE {
                let place = [column, row].map(|at| (at as f64 + 0.5) * CELL);
                let inside = |[low, high]: &&[[f64; 2]; 2]| {
                    (0..2).all(|axis| low[axis] < place[axis] && place[axis] < high[axis])
                };
                let covered = blocks.iter().filter(inside).count();
                assert_eq!(covered, usize::from(plan.is_occupied(place)), "{place:?}");
            }
        }
    }
}
