//! Exported worlds are well-formed, and state the episode.

use opendr_engine::ErrorKind;
use opendr_engine::params::{ParamMap, ParamValue};
use opendr_simulation::Registry;

use super::export;

/// Checks brackets and texts, and that every number is finite.
fn check(world: &str) {
    let mut open = Vec::new();
    let mut letters = world.chars();
    while let Some(letter) = letters.next() {
        match letter {
            '#' => drop(letters.find(|letter| *letter == '\n')),
            '"' => assert!(letters.any(|letter| letter == '"')),
            '{' | '[' => open.push(letter),
            '}' => assert_eq!(open.pop(), Some('{')),
            ']' => assert_eq!(open.pop(), Some('[')),
            _ => {}
        }
    }
    assert!(open.is_empty());
    assert!(!world.contains("NaN") && !world.split_whitespace().any(|word| word == "inf"));
}

#[test]
fn every_world_is_exported() {
    for id in Registry::builtin().ids() {
        let files = export(id, &ParamMap::new(), 3).unwrap();
        let world = &files.world;
        check(world);
        assert!(world.starts_with("#VRML_SIM R2023b utf8\n"), "{id}");
        assert!(
            world.contains(&format!("title \"{id}, seed 3")) && world.contains("controller \"<extern>\"")
        );
        assert_eq!(files, export(id, &ParamMap::new(), 3).unwrap());
        assert_ne!(files, export(id, &ParamMap::new(), 4).unwrap(), "{id}");
        assert_eq!(world.matches("ImageTexture").count(), files.textures.len(), "{id}");
    }
    assert_eq!(export("Walker-v1", &ParamMap::new(), 0).unwrap_err().kind(), ErrorKind::NotFound);
}

#[test]
fn parameters_and_variants_change_the_world() {
    let with = |id: &str, name: &str, value: ParamValue| {
        export(id, &ParamMap::from([(name.to_owned(), value)]), 1).map(|files| files.world)
    };
    assert!(with("Pendulum-v1", "g", ParamValue::Float(3.5)).unwrap().contains("gravity 3.5\n"));
    let solids = |world: &str| world.matches("boundingObject").count();
    let dense = export("UavDepthCorridor-dense-v1", &ParamMap::new(), 1).unwrap().world;
    assert!((9..=13).contains(&solids(&dense)), "{}", solids(&dense));
    let few = with("UavDepthCorridor-v1", "max_obstacles", ParamValue::Int(2)).unwrap();
    // Two obstacles, the ground, and two walls or none.
    assert!([3, 5].contains(&solids(&few)), "{}", solids(&few));
    assert!(with("Pendulum-v1", "gg", ParamValue::Int(1)).is_err());
}

#[test]
fn the_initial_state_is_that_of_the_episode() {
    let mut cart = opendr_simulation::make("CartPole-v1").unwrap();
    let mut state = [0.0; 4];
    cart.reset(Some(9), &ParamMap::new(), &mut state).unwrap();
    let world = export("CartPole-v1", &ParamMap::new(), 9).unwrap().world;
    assert!(world.contains(&format!("position {}\n", f64::from(state[0]))));
    assert!(world.contains(&format!("rotation 0 1 0 {}\n", f64::from(state[2]))));
}

#[test]
fn motors_of_a_gantry_are_the_actions() {
    for (id, motors) in [
        ("PlanarPush-v1", &["x", "y"][..]),
        ("PlanarPeg-v1", &["x", "y", "turn", "right finger", "left finger"]),
        ("PlanarGrasp-v1", &["x", "y", "lift", "turn", "right finger", "left finger"]),
    ] {
        let world = export(id, &ParamMap::new(), 2).unwrap().world;
        assert_eq!(world.matches("Motor {").count(), motors.len(), "{id}");
        for motor in motors {
            assert!(world.contains(&format!("name \"{motor}\"\n")), "{id}: {motor}");
        }
    }
}

#[test]
fn the_pusher_is_where_the_episode_begins() {
    let mut push = opendr_simulation::make("PlanarPush-v1").unwrap();
    let mut seen = [0.0; 6];
    push.reset(Some(4), &ParamMap::new(), &mut seen).unwrap();
    let world = export("PlanarPush-v1", &ParamMap::new(), 4).unwrap().world;
    let starts: Vec<f64> = world
        .lines()
        .filter_map(|line| line.trim().strip_prefix("position "))
        .filter_map(|number| number.parse().ok())
        .collect();
    for (start, seen) in starts.iter().zip(seen) {
        assert!((start - 0.3 * f64::from(seen)).abs() < 1e-6, "{starts:?} {seen}");
    }
    assert_eq!(starts.len(), 2);
}

#[test]
fn arms_have_the_joints_of_the_urdf() {
    for id in ["MobileManipReach-v1", "MobileManipDoor-diff-v1"] {
        let world = export(id, &ParamMap::new(), 6).unwrap().world;
        assert_eq!(world.matches("RotationalMotor {").count(), 7, "{id}");
        assert!(world.contains("name \"elbow_flex\"") && world.contains("minPosition -2.2"));
        let goals = world.matches("DEF GOAL_").count();
        assert_eq!(goals, if id.contains("Door") { 3 } else { 1 });
    }
}

#[test]
fn textures_are_saved_beside_the_world() {
    let folder = std::env::temp_dir().join(format!("opendr-webots-export-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let files = export("SphereView-Object-v1", &ParamMap::new(), 2).unwrap();
    assert!(!files.textures.is_empty());
    let written = files.save(folder.join("object.wbt")).unwrap();
    assert_eq!(written.len(), files.textures.len() + 1);
    for (url, image) in &files.textures {
        assert!(files.world.contains(&format!("url [ \"{url}\" ]")));
        assert_eq!(&opendr_vision::open(folder.join(url)).unwrap(), image);
    }
    std::fs::remove_dir_all(&folder).unwrap();
    let error = files.save("/proc/no/object.wbt").unwrap_err();
    assert_eq!(error.kind(), ErrorKind::NotFound, "{error}");
}
