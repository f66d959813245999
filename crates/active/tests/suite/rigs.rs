//! Rigs without a simulator.

use opendr_active::rig::{PanTiltZoom, RecordedViews, RigOptions};
use opendr_engine::ErrorKind;
use opendr_engine::data::{Image, Pixels};
use opendr_engine::params::ParamValue;
use opendr_engine::rig::{Limit, ViewRig as _};
use opendr_engine::target::Action;

fn level(image: &Image) -> u8 {
    let Pixels::U8(pixels) = image.pixels() else { return 0 };
    pixels[0]
}

#[test]
fn a_window_pans_tilts_and_zooms() {
    // Brighter to the right.
    let pixels: Vec<u8> = (0..200 * 100).flat_map(|at| [(at % 200) as u8; 3]).collect();
    let image = Image::from_rgb8(pixels, 200, 100).unwrap();
    let mut camera = PanTiltZoom::new(image, 1.0, [50, 25]).unwrap();
    assert_eq!(camera.window(), [0, 0, 200, 100]);
    let mut apply = |axes: &[f32]| camera.apply(&Action::new(axes).unwrap()).unwrap();
    apply(&[0.0, 0.0, 1.0]);
    apply(&[0.0, 0.0, 1.0]);
    let stopped = apply(&[-1.0, 1.0, 1.0]);
    assert_eq!(stopped.limits, [None; 4]);
    let zoomed = camera.window();
    // To the right and up, 0.2 rad of one: 40 of 200 pixels, and 10 of 100.
    assert_eq!(zoomed, [100, 10, 80, 40]);
    let picture = camera.capture().unwrap();
    assert_eq!([picture.width(), picture.height()], [50, 25]);
    assert!((99..=102).contains(&level(&picture)), "{}", level(&picture));
    for _ in 0..9 {
        camera.apply(&Action::new(&[-1.0, 0.0, 0.0]).unwrap()).unwrap();
    }
    let stopped = camera.apply(&Action::new(&[-1.0, 0.0, 0.0]).unwrap()).unwrap();
    assert_eq!(stopped.limits[0], Some(Limit::Low));
    assert_eq!(camera.window()[0], 120);
}

#[test]
fn recorded_views_are_captured_where_they_are_nearest() {
    let folder = std::env::temp_dir().join(format!("opendr-recorded-views-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut views = Vec::new();
    for (number, azimuth) in [0.0, 1.0, 2.0].into_iter().enumerate() {
        let image = Image::from_rgb8(vec![50 * number as u8; 12], 2, 2).unwrap();
        opendr_vision::save(&image, folder.join(format!("{number}.png"))).unwrap();
        views.push(format!(
            r#"{{"image": "{number}.png", "pose": {{"azimuth": {azimuth}, "elevation": 0, "distance": 1}}}}"#
        ));
    }
    let axes = r#"[{"name": "azimuth", "step": 0.6, "low": -3.14, "high": 3.14, "wraps": true}]"#;
    let index = folder.join("views.json");
    std::fs::write(&index, format!(r#"{{"axes": {axes}, "views": [{}]}}"#, views.join(", "))).unwrap();
    let mut rig = RecordedViews::open(&index).unwrap();
    let mut seen = vec![level(&rig.capture().unwrap())];
    for _ in 0..3 {
        rig.apply(&Action::new(&[1.0]).unwrap()).unwrap();
        seen.push(level(&rig.capture().unwrap()));
    }
    assert_eq!(seen, [0, 50, 50, 100]);
    assert!((rig.pose().azimuth - 2.0).abs() < 1e-9);
    std::fs::write(&index, format!(r#"{{"axes": {axes}, "views": []}}"#)).unwrap();
    assert_eq!(RecordedViews::open(&index).err().map(|error| error.kind()), Some(ErrorKind::Format));
    std::fs::write(&index, "{}").unwrap();
    assert_eq!(RecordedViews::open(&index).err().map(|error| error.kind()), Some(ErrorKind::Format));
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn rigs_are_opened_by_name_with_the_options_of_their_kind() {
    let folder = std::env::temp_dir().join(format!("opendr-named-rigs-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (hall, index) = (folder.join("hall.png"), folder.join("views.json"));
    let image = Image::from_rgb8(vec![70; 3 * 40 * 20], 40, 20).unwrap();
    opendr_vision::save(&image, &hall).unwrap();
    let axes = r#"[{"name": "azimuth", "step": 0.6, "low": -3.14, "high": 3.14, "wraps": true}]"#;
    let pose = r#"{"azimuth": 0, "elevation": 0, "distance": 1}"#;
    let text = format!(r#"{{"axes": {axes}, "views": [{{"image": "hall.png", "pose": {pose}}}]}}"#);
    std::fs::write(&index, text).unwrap();
    let [hall, index] = [hall, index].map(|path| path.display().to_string());

    let plain = RigOptions::default();
    let seeded = RigOptions { seed: Some(3), ..RigOptions::default() };
    let wide = RigOptions { field_of_view: Some(2.0), ..RigOptions::default() };
    let axes_of = |options: &RigOptions, rig: &str| options.open(rig).map(|rig| rig.axes().to_vec());
    let world = "SphereView-Pose-v1";
    for (options, rig, count) in
        [(&plain, world, 3), (&seeded, world, 3), (&plain, &index, 1), (&plain, &hall, 3), (&wide, &hall, 3)]
    {
        assert_eq!(axes_of(options, rig).unwrap().len(), count, "{rig}");
    }
    let high = |options| axes_of(options, &hall).unwrap()[0].high;
    assert_eq!((high(&plain), high(&wide)), (0.5, 1.0));
    assert_ne!(plain.open(world).unwrap().capture().unwrap(), seeded.open(world).unwrap().capture().unwrap());
    for (options, rig) in [(&wide, world), (&wide, &index), (&seeded, &index), (&seeded, &hall)] {
        let error = axes_of(options, rig).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidParam, "{rig}: {error}");
    }
    let parameter = [("unknown".to_owned(), ParamValue::Int(1))];
    let wrong = RigOptions { params: parameter.into(), ..RigOptions::default() };
    assert!(axes_of(&wrong, world).is_err() && axes_of(&wrong, &hall).is_err());
    assert_eq!(axes_of(&plain, "nowhere").unwrap_err().kind(), ErrorKind::NotFound);
    std::fs::remove_dir_all(&folder).unwrap();
}
