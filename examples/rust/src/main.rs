//! Runs an example by its name; without a name, lists them. `README.md` beside the folders of the examples shows what they draw.
//!
//! Each file is a program of its own: as `src/main.rs` of a package that depends on `opendr`, it runs as it is.

use std::process::ExitCode;

macro_rules! examples {
    ($($name:ident),* $(,)?) => {
        $(mod $name;)*

        /// Name, function and source of each example.
        const EXAMPLES: &[(&str, fn() -> opendr::Result<()>, &str)] =
            &[$((stringify!($name), $name::main, include_str!(concat!(stringify!($name), ".rs")))),*];
    };
}

examples!(
    train_policy,
    swing_up,
    spot_keyword,
    render_scenes,
    recognise_action,
    read_recording,
    orbit_object,
    lidar_boxes,
    heart_beats,
    evaluate_detector,
    detect_voice,
    detect_grasps,
    ambiguous_map,
    choose_classes,
    detect_faces,
    detect_falls,
    detect_objects,
    estimate_poses,
    face_mesh,
    mask_persons,
    name_expression,
    name_gesture,
    own_network,
    panoptic,
    read_hand,
    read_text,
    recognise_faces,
    segment_scene,
    stereo_depth,
    track_objects,
    train_classifier,
);

fn main() -> ExitCode {
    let Some(name) = std::env::args().nth(1) else {
        for (name, _, source) in EXAMPLES {
            let about = source.lines().next().unwrap_or_default().trim_start_matches("//! ");
            println!("{name}: {about}");
        }
        return ExitCode::SUCCESS;
    };
    let Some((_, example, _)) = EXAMPLES.iter().find(|(known, ..)| *known == name) else {
        eprintln!("no example {name:?}; run without a name for the list");
        return ExitCode::FAILURE;
    };
    match example() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
