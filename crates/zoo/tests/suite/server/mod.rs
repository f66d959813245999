//! A local HTTP server with faults on demand.

use std::collections::{HashMap, VecDeque};
use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Condvar, Mutex};
use std::thread;

/// Fault of one response.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// No fault.
    None,
    /// Only this status.
    Status(u16),
    /// Closes after so many bytes of the body.
    Truncate(usize),
    /// Sends so many bytes of the body and then nothing, until [`Server::go_on`].
    Stall(usize),
    /// Flips the lowest bit of this byte of the file.
    Flip(usize),
    /// Sends everyone to this path.
    Redirect(&'static str),
    /// Ignores `Range`.
    NoRange,
    /// Answers a range with the one that begins so many bytes later.
    WrongRange(u64),
    /// Announces so many bytes more than there are.
    Announce(i64),
    /// States no length and sends so many bytes too many.
    Endless(usize),
}

#[derive(Default)]
struct State {
    files: Mutex<HashMap<String, Vec<u8>>>,
    faults: Mutex<VecDeque<Fault>>,
    requests: Mutex<Vec<Request>>,
    etag: Mutex<String>,
    stalled: Mutex<bool>,
    go_on: Condvar,
}

/// A received request.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    pub path: String,
    pub range: Option<u64>,
    pub if_range: Option<String>,
}

/// Serves until the test ends.
#[derive(Clone)]
pub struct Server {
    pub address: String,
    state: Arc<State>,
}

impl Server {
    pub fn new() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("http://{}", listener.local_addr().unwrap());
        let state = Arc::new(State { etag: Mutex::new("\"one\"".into()), ..State::default() });
        let shared = Arc::clone(&state);
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let state = Arc::clone(&shared);
                // A client that goes away in the middle is part of the tests.
                thread::spawn(move || drop(answer(stream, &state)));
            }
        });
        Self { address, state }
    }

    pub fn put(&self, path: &str, bytes: &[u8]) {
        self.state.files.lock().unwrap().insert(path.into(), bytes.to_vec());
    }

    /// Sets the faults of the next responses, in order.
    pub fn fail(&self, faults: impl IntoIterator<Item = Fault>) {
        self.state.faults.lock().unwrap().extend(faults);
    }

    pub fn set_etag(&self, etag: &str) {
        *self.state.etag.lock().unwrap() = etag.into();
    }

    /// Returns and clears the requests so far.
    pub fn requests(&self) -> Vec<Request> {
        std::mem::take(&mut self.state.requests.lock().unwrap())
    }

    pub fn go_on(&self) {
        *self.state.stalled.lock().unwrap() = true;
        self.state.go_on.notify_all();
    }
}

fn read_request(stream: &TcpStream) -> std::io::Result<Request> {
    let mut lines = BufReader::new(stream).lines();
    let first = lines.next().unwrap_or_else(|| Ok(String::new()))?;
    let path = first.split(' ').nth(1).unwrap_or_default().to_owned();
    let mut request = Request { path, range: None, if_range: None };
    for line in lines {
        let line = line?;
        let Some((name, value)) = line.split_once(": ") else { break };
        match name.to_ascii_lowercase().as_str() {
            "range" => {
                let start = value.trim_start_matches("bytes=").trim_end_matches('-');
                request.range = Some(start.parse().unwrap());
            }
            "if-range" => request.if_range = Some(value.to_owned()),
            _ => {}
        }
    }
    Ok(request)
}

fn answer(mut stream: TcpStream, state: &State) -> std::io::Result<()> {
    let request = read_request(&stream)?;
    state.requests.lock().unwrap().push(request.clone());
    let fault = state.faults.lock().unwrap().pop_front().unwrap_or(Fault::None);
    let etag = state.etag.lock().unwrap().clone();
    let head = match (&fault, state.files.lock().unwrap().get(&request.path)) {
        (Fault::Status(status), _) => Err(format!("HTTP/1.1 {status} As Asked\r\n")),
        (Fault::Redirect(to), _) => Err(format!("HTTP/1.1 302 Found\r\nLocation: {to}\r\n")),
        (_, None) => Err("HTTP/1.1 404 Not Found\r\n".to_owned()),
        (_, Some(file)) => Ok(file.clone()),
    };
    let mut file = match head {
        Ok(file) => file,
        Err(head) => return write!(stream, "{head}Content-Length: 0\r\nConnection: close\r\n\r\n"),
    };
    if let Fault::Flip(at) = fault {
        file[at] ^= 1;
    }
    let same = request.if_range.as_ref().is_none_or(|validator| *validator == etag);
    let mut start = request.range.filter(|_| same && fault != Fault::NoRange).unwrap_or(0);
    let mut head =
        if start > 0 { "HTTP/1.1 206 Partial Content\r\n" } else { "HTTP/1.1 200 OK\r\n" }.to_owned();
    if let Fault::WrongRange(later) = fault {
        start += later;
    }
    if head.contains("206") {
        head += &format!("Content-Range: bytes {start}-{}/{}\r\n", file.len() - 1, file.len());
    }
    let body = &file[start as usize..];
    match fault {
        Fault::Announce(more) => head += &format!("Content-Length: {}\r\n", body.len() as i64 + more),
        Fault::Endless(_) => {}
        _ => head += &format!("Content-Length: {}\r\n", body.len()),
    }
    write!(stream, "{head}ETag: {etag}\r\nConnection: close\r\n\r\n")?;
    match fault {
        Fault::Truncate(count) => stream.write_all(&body[..count]),
        Fault::Stall(count) => {
            stream.write_all(&body[..count])?;
            let stalled = state.stalled.lock().unwrap();
            drop(state.go_on.wait_while(stalled, |go_on| !*go_on).unwrap());
            Ok(())
        }
        Fault::Endless(more) => {
            stream.write_all(body)?;
            stream.write_all(&vec![0; more])
        }
        _ => stream.write_all(body),
    }
}
