use crate::params::{ParamKind, ParamMap, ParamValue, Params};

crate::choices! {
    enum Mode { Fast = "fast", Exact = "exact" }
}

/// Fields of every type.
#[derive(Debug, Clone, PartialEq, Params)]
struct All {
    /// Detections below this score are dropped.
    ///
    /// More text.
    #[param(default = 0.35, range = 0.0..=1.0, live)]
    threshold: f32,
    /// Side.
    #[param(default = 416, range = 32..=2048, unit = "px")]
    size: usize,
    /// Mode.
    mode: Mode,
    /// Rate.
    #[param(default = 1e-3, range = 1e-6..=1.0, log)]
    rate: f64,
    /// Name.
    #[param(default = "none at all")]
    name: String,
    /// Limit.
    limit: Option<i64>,
    /// Steps.
    #[param(default = vec![8, 16, 32], range = 1..=64)]
    strides: Vec<u32>,
    /// Verbose.
    verbose: bool,
}

#[test]
fn table_is_complete() {
    let [threshold, size, mode, rate, name, limit, strides, verbose] = All::FIELDS else {
        panic!("8 fields")
    };
    assert_eq!(threshold.doc, "Detections below this score are dropped.\n\nMore text.");
    assert!(threshold.live && !size.live && rate.log_scale && limit.optional);
    assert_eq!((size.unit, size.kind), ("px", ParamKind::Int));
    assert_eq!(mode.choices, ["fast", "exact"]);
    assert_eq!(threshold.default.value(), ParamValue::Float(0.35));
    assert_eq!(name.default.value(), ParamValue::Text("none at all".into()));
    assert_eq!(strides.kind, ParamKind::List);
    assert_eq!(verbose.default.value(), ParamValue::Bool(false));
    All::default().check().unwrap();
}

#[test]
fn text_of_a_command_line() {
    let mut all = All::default();
    for (name, text) in [
        ("threshold", "0.5"),
        ("size", "320"),
        ("mode", "exact"),
        ("limit", "7"),
        ("strides", "4,8"),
        ("verbose", "yes"),
    ] {
        all.set_text(name, text).unwrap();
    }
    assert_eq!((all.threshold, all.size, all.mode, all.limit), (0.5, 320, Mode::Exact, Some(7)));
    assert_eq!((&all.strides[..], all.verbose), (&[4, 8][..], true));
    all.set_text("limit", "none").unwrap();
    assert_eq!(all.limit, None);
}

#[test]
fn wrong_values_are_rejected_by_name() {
    let mut all = All::default();
    for (name, value, part) in [
        ("threshold", ParamValue::Float(1.5), "threshold = 1.5 is out of range 0..=1"),
        ("threshold", ParamValue::Float(f64::NAN), "out of range"),
        ("threshold", ParamValue::Text("a".into()), "threshold = a should be a float"),
        ("size", ParamValue::Float(0.5), "size = 0.5 should be an int"),
        ("size", ParamValue::Int(-1), "out of range"),
        ("mode", ParamValue::Text("slow".into()), "give one of fast, exact"),
        ("strides", ParamValue::List(vec![ParamValue::Int(65)]), "out of range"),
        ("strides", ParamValue::List(vec![ParamValue::Text("a".into())]), "should be a list"),
        ("nothing", ParamValue::None, "no parameter \"nothing\"; there are threshold, size"),
        ("verbose", ParamValue::Int(1), "should be a bool"),
    ] {
        let error = all.set(name, value).unwrap_err();
        assert_eq!(error.kind(), crate::ErrorKind::InvalidParam);
        assert!(error.to_string().contains(part), "{error}");
    }
    assert_eq!(all, All::default());
}

#[test]
fn map_and_json_round_trip() {
    let mut all = All::default();
    all.set_text("threshold", "0.7").unwrap();
    let text = serde_json::to_string(&all.to_map()).unwrap();
    let map: ParamMap = serde_json::from_str(&text).unwrap();
    assert_eq!(All::from_map(&map).unwrap(), all);
    assert!(text.contains("\"threshold\":0.7,"), "{text}");
}

/// Fields before, within and after a flattened struct.
#[derive(Debug, Clone, Params)]
struct Outer {
    /// Before.
    #[param(default = 1, range = 0..=9)]
    before: i64,
    /// Within.
    #[param(flatten, rate = 0.5, name = "other")]
    inner: Inner,
    /// After.
    #[param(default = 3)]
    after: i64,
}

/// A struct to flatten.
#[derive(Debug, Clone, Params)]
struct Inner {
    /// A rate.
    #[param(default = 0.1, range = 0.0..=1.0)]
    rate: f64,
    /// A name.
    #[param(default = "own")]
    name: String,
}

#[test]
fn flattened_fields_are_in_order() {
    let names: Vec<_> = Outer::FIELDS.iter().map(|field| field.name).collect();
    assert_eq!(names, ["before", "rate", "name", "after"]);
    let mut params = Outer::default();
    assert_eq!((params.inner.rate, params.inner.name.as_str()), (0.5, "other"));
    assert_eq!(Inner::default().rate, 0.1);
    for (index, field) in Outer::FIELDS.iter().enumerate() {
        assert_eq!(field.default.value(), params.get_at(index), "{}", field.name);
    }
    params.set("rate", 0.25.into()).unwrap();
    params.set("after", 7.into()).unwrap();
    assert_eq!((params.inner.rate, params.before, params.after), (0.25, 1, 7));
    assert!(params.set("rate", 2.0.into()).is_err());
    assert_eq!(Outer::from_map(&params.to_map()).unwrap().to_map(), params.to_map());
}
