use std::io::{Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use opendr_engine::data::{Image, PointCloud, Timeseries};
use opendr_engine::params::{Field, FieldDefault, ParamKind, ParamMap, ParamRange, ParamValue};
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{Error, Value};

use super::*;

static DEFAULT: ParamValue = ParamValue::Float(0.5);
static FIELDS: [Field; 2] = [field("threshold", true), field("size", false)];

const fn field(name: &'static str, live: bool) -> Field {
    Field {
        name,
        doc: "Minimum score.",
        kind: ParamKind::Float,
        optional: false,
        choices: &[],
        range: Some(ParamRange { low: 0.0, high: 1.0 }),
        unit: "",
        log_scale: false,
        live,
        aliases: &[],
        former: &[],
        default: FieldDefault::Value(&DEFAULT),
    }
}

fn viewer(options: ViewerOptions) -> Viewer {
    Viewer::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, 0)), options).unwrap()
}

fn port(viewer: &Viewer) -> u16 {
    let url = viewer.url();
    let authority = url.strip_prefix("http://").unwrap().split('/').next().unwrap();
    authority.rsplit(':').next().unwrap().parse().unwrap()
}

/// Sends bytes and returns status and body.
fn exchange(viewer: &Viewer, request: &[u8]) -> (u16, Vec<u8>) {
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port(viewer))).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    // The server may refuse before everything is sent.
    stream.write_all(request).ok();
    let mut response = Vec::new();
    stream.read_to_end(&mut response).ok();
    let end = response.windows(4).position(|window| window == b"\r\n\r\n").unwrap();
    let status = std::str::from_utf8(&response[9..12]).unwrap().parse().unwrap();
    (status, response[end + 4..].to_vec())
}

fn get(viewer: &Viewer, path: &str, headers: &str) -> (u16, Vec<u8>) {
    exchange(viewer, format!("GET {path} HTTP/1.1\r\nConnection: close\r\n{headers}\r\n").as_bytes())
}

fn post(viewer: &Viewer, headers: &str, body: &str) -> (u16, String) {
    let length = body.len();
    let head = format!(
        "POST /api/params HTTP/1.1\r\nConnection: close\r\nContent-Length: {length}\r\n{headers}\r\n"
    );
    let (status, body) = exchange(viewer, (head + body).as_bytes());
    (status, String::from_utf8(body).unwrap())
}

const HOST: &str = "Host: localhost:7007\r\n";
const JSON: &str = "Host: localhost\r\nContent-Type: application/json\r\n";

fn shown(index: u64, input: Value) -> Shown {
    let boxes = BoundingBoxList::from(vec![BoundingBox::new(0, 4.0, 4.0, 24.0, 24.0, 0.9)]);
    Shown {
        name: "street.png".to_owned(),
        index,
        input,
        outputs: vec![("boxes".to_owned(), boxes.into())],
        notes: vec![("reward".to_owned(), "0.5".to_owned())],
        stages: vec![("pre", 1.0), ("network", 2.0)],
    }
}

fn picture() -> Value {
    Image::from_rgb8(vec![40; 32 * 32 * 3], 32, 32).unwrap().into()
}

fn parts(bytes: &[u8]) -> (serde_json::Value, &[u8]) {
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    (serde_json::from_slice(&bytes[4..4 + length]).unwrap(), &bytes[4 + length..])
}

#[test]
fn pages_and_newest_items_are_served() {
    let viewer = viewer(ViewerOptions { title: "NanoDet".to_owned(), ..ViewerOptions::default() });
    let (status, page) = get(&viewer, "/", HOST);
    assert_eq!(status, 200);
    assert!(String::from_utf8(page).unwrap().contains("viewer.js"));
    for path in ["/viewer.js", "/viewer.css", "/cloud.js", "/plots.js", "/icon.svg"] {
        assert_eq!(get(&viewer, path, HOST).0, 200, "{path}");
    }
    let state: serde_json::Value = serde_json::from_slice(&get(&viewer, "/api/state", HOST).1).unwrap();
    assert_eq!((&state["title"], &state["is_writable"]), (&"NanoDet".into(), &false.into()));
    viewer.show(shown(0, picture()));
    viewer.show(shown(1, picture()));
    let (status, body) = get(&viewer, "/api/next?after=0", HOST);
    let (head, jpeg) = parts(&body);
    assert_eq!((status, &head["number"], &head["index"]), (200, &2.into(), &1.into()));
    assert_eq!((&head["kind"], &head["stages_ms"][1][0]), (&"image".into(), &"network".into()));
    assert!(head["outputs"][0]["text"].as_str().unwrap().contains("0.9"));
    let drawn = opendr_vision::decode(jpeg).unwrap();
    let (_, body) = get(&viewer, "/api/next?after=0&plain=1", HOST);
    let plain = opendr_vision::decode(parts(&body).1).unwrap();
    assert_eq!((drawn.width(), plain.width()), (32, 32));
    assert_ne!(drawn, plain);
    assert_eq!(get(&viewer, "/api/next?after=x", HOST).0, 400);
}

#[test]
fn a_request_waits_for_the_next_item() {
    let viewer = viewer(ViewerOptions::default());
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| get(&viewer, "/api/next?after=0", HOST));
        std::thread::sleep(Duration::from_millis(50));
        viewer.show(shown(0, picture()));
        assert_eq!(waiting.join().unwrap().0, 200);
    });
    let begin = Instant::now();
    assert_eq!(get(&viewer, "/api/next?after=1", HOST).0, 204);
    assert!(begin.elapsed() > Duration::from_secs(4));
}

#[test]
fn clouds_and_series_are_sent_as_numbers() {
    let viewer = viewer(ViewerOptions::default());
    let cloud = PointCloud::new(vec![1.0, 2.0, 3.0, f32::NAN, 5.0, 6.0], [2, 3]).unwrap();
    viewer.show(shown(0, cloud.into()));
    let (_, body) = get(&viewer, "/api/next?after=0", HOST);
    let (head, points) = parts(&body);
    assert_eq!((&head["kind"], &head["points"]), (&"points".into(), &2.into()));
    let numbers: Vec<_> =
        points.chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect();
    assert_eq!(numbers, [1.0, 2.0, 3.0, 0.0, 0.0, 5.0, 6.0, 0.0]);
    let series = Timeseries::new(vec![1.0, -1.0, 2.0, -2.0], [2, 2]).unwrap();
    viewer.show(shown(1, series.into()));
    let (_, body) = get(&viewer, "/api/next?after=1", HOST);
    let (head, bounds) = parts(&body);
    assert_eq!((&head["kind"], &head["traces"], bounds.len()), (&"traces".into(), &2.into(), 2 * 2 * 2 * 4));
}

#[test]
fn other_origins_and_hosts_are_refused() {
    let viewer = viewer(ViewerOptions::default());
    for host in ["localhost", "localhost:7007", "127.0.0.1:1", "[::1]:80", "127.1.2.3"] {
        assert_eq!(get(&viewer, "/api/state", &format!("Host: {host}\r\n")).0, 200, "{host}");
    }
    for headers in [
        "",
        "Host: evil.example\r\n",
        "Host: localhost.evil.example:7007\r\n",
        "Host: 10.0.0.1\r\n",
        "Host: localhost\r\nOrigin: http://evil.example\r\n",
        "Host: localhost\r\nOrigin: null\r\n",
        "Host: localhost\r\nSec-Fetch-Site: cross-site\r\n",
    ] {
        assert_eq!(get(&viewer, "/api/state", headers).0, 403, "{headers}");
        assert_eq!(get(&viewer, "/", headers).0, 403, "{headers}");
    }
    assert_eq!(get(&viewer, "/api/state", "Host: localhost\r\nOrigin: http://localhost\r\n").0, 200);
    assert_eq!(get(&viewer, "/api/state", "Host: localhost\r\nHost: localhost\r\n").0, 400);
}

#[test]
fn a_viewer_of_other_machines_needs_its_token() {
    let viewer = Viewer::bind("0.0.0.0:0".parse().unwrap(), ViewerOptions::default()).unwrap();
    let url = viewer.url();
    let token = url.split_once("?token=").unwrap().1;
    assert_eq!(token.len(), 32);
    assert_eq!(get(&viewer, "/", "Host: robot.local\r\n").0, 200);
    let with = |token: &str| {
        get(&viewer, "/api/state", &format!("Host: robot.local\r\nX-OpenDR-Token: {token}\r\n")).0
    };
    assert_eq!(with(token), 200);
    assert_eq!(with(&token[1..]), 403);
    assert_eq!(with(&token.chars().rev().collect::<String>()), 403);
    assert_eq!(get(&viewer, "/api/state", "Host: robot.local\r\n").0, 403);
    assert_eq!(get(&viewer, "/api/next?after=0&token=x", "Host: robot.local\r\n").0, 403);
}

#[test]
fn live_parameters_change_where_allowed() {
    let options = ViewerOptions { params: &FIELDS, is_writable: true, ..ViewerOptions::default() };
    let viewer = viewer(options);
    let mut last = 0;
    assert_eq!(viewer.changes(&mut last), []);
    for step in 0..1000 {
        viewer.shared.settings.request("threshold", ParamValue::Float(f64::from(step) / 1000.0)).unwrap();
    }
    assert_eq!(viewer.changes(&mut last), [("threshold".to_owned(), ParamValue::Float(0.999))]);
    assert_eq!(viewer.changes(&mut last), []);
    assert_eq!(post(&viewer, JSON, r#"{"name": "threshold", "value": 0.25}"#).0, 204);
    assert_eq!(viewer.changes(&mut last), [("threshold".to_owned(), ParamValue::Float(0.25))]);
    for (body, text) in [
        (r#"{"name": "threshold", "value": 2.0}"#, "threshold"),
        (r#"{"name": "size", "value": 0.5}"#, "size"),
        (r#"{"name": "threshold", "value": "high"}"#, "threshold"),
        ("{", "EOF"),
        ("", "EOF"),
    ] {
        let (status, found) = post(&viewer, JSON, body);
        assert_eq!(status, 400, "{body}");
        assert!(found.contains(text), "{body}: {found}");
    }
    assert_eq!(post(&viewer, HOST, r#"{"name": "threshold", "value": 0.1}"#).0, 400);
    let origin = format!("{JSON}Origin: http://evil.example\r\n");
    assert_eq!(post(&viewer, &origin, r#"{"name": "threshold", "value": 0.1}"#).0, 403);
    assert_eq!(viewer.changes(&mut last), []);
    let reader =
        self::viewer(ViewerOptions { params: &FIELDS, values: ParamMap::new(), ..ViewerOptions::default() });
    assert_eq!(post(&reader, JSON, r#"{"name": "threshold", "value": 0.1}"#).0, 403);
}

#[test]
fn curves_are_read_anew() {
    let count = AtomicUsize::new(5000);
    let read = move || match count.fetch_add(1, Ordering::Relaxed) {
        5001 => Err(Error::format("line 3 of the log has no number")),
        count => {
            let points = (1..=count).map(|step| [step as f64, 1.0 / step as f64]).collect();
            Ok(vec![Curve { name: "loss".to_owned(), points, is_scatter: false }])
        }
    };
    let curves = CurveSource { unit: "step", read: Box::new(read) };
    let viewer = viewer(ViewerOptions { curves: Some(curves), ..ViewerOptions::default() });
    let (status, body) = get(&viewer, "/api/curves", HOST);
    assert_eq!(status, 200);
    let curves: serde_json::Value = serde_json::from_slice(&body).unwrap();
    assert_eq!(curves["unit"], "step");
    let points = curves["curves"][0]["points"].as_array().unwrap();
    assert!(points.len() <= 1001);
    assert_eq!(points.last().unwrap()[0], 5000.0);
    assert_eq!(get(&viewer, "/api/curves", HOST).0, 503);
    assert_eq!(get(&self::viewer(ViewerOptions::default()), "/api/curves", HOST).0, 404);
}

#[test]
fn hostile_requests_are_refused() {
    let viewer = viewer(ViewerOptions::default());
    let long = format!("GET /{} HTTP/1.1\r\n\r\n", "a".repeat(20_000));
    let many = format!("GET / HTTP/1.1\r\n{}\r\n", "A: b\r\n".repeat(100));
    let large = format!("POST /api/params HTTP/1.1\r\n{HOST}Content-Length: {}\r\n\r\n", 1 << 30);
    for (request, status) in [
        (long.as_str(), 431),
        (&many, 431),
        (&large, 413),
        ("\u{16}\u{3}\u{1}\u{2}\r\n\r\n", 400),
        ("GET / HTTP/1.1\r\nContent-Length: x\r\n\r\n", 400),
        ("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400),
        ("POST / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n", 400),
    ] {
        assert_eq!(exchange(&viewer, request.as_bytes()).0, status, "{request:.60}");
    }
    for path in ["/../Cargo.toml", "//etc/passwd", "/page/index.html", "/viewer.js/", "/%2e%2e/x", "/api"] {
        assert_eq!(get(&viewer, path, HOST).0, 404, "{path}");
    }
    let delete = format!("DELETE / HTTP/1.1\r\nConnection: close\r\n{HOST}\r\n");
    assert_eq!(exchange(&viewer, delete.as_bytes()).0, 405);
}

#[test]
fn mutated_requests_do_no_harm() {
    let viewer = viewer(ViewerOptions { params: &FIELDS, is_writable: true, ..ViewerOptions::default() });
    viewer.show(shown(0, picture()));
    let body = r#"{"name": "threshold", "value": 0.25}"#;
    let length = body.len();
    let seed = format!("POST /api/params HTTP/1.1\r\n{JSON}Content-Length: {length}\r\n\r\n{body}");
    let mut state = 1_u64;
    let mut random = |bound: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % bound
    };
    for _ in 0..20_000 {
        let mut bytes = seed.clone().into_bytes();
        for _ in 0..1 + random(4) {
            let at = random(bytes.len());
            bytes[at] = random(256) as u8;
        }
        bytes.truncate(1 + random(bytes.len()));
        let mut rest = Vec::new();
        let mut stream = bytes.as_slice();
        if let Ok(request) = request::Request::read(&mut stream, &mut rest) {
            viewer.shared.response(&request);
        }
    }
    assert_eq!(get(&viewer, "/api/state", HOST).0, 200);
}

#[test]
fn connections_beyond_the_limit_are_refused_and_others_go_on() {
    let viewer = viewer(ViewerOptions::default());
    let held: Vec<_> =
        (0..32).map(|_| TcpStream::connect((Ipv4Addr::LOCALHOST, port(&viewer))).unwrap()).collect();
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(get(&viewer, "/", HOST).0, 503);
    drop(held);
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(get(&viewer, "/", HOST).0, 200);
}
