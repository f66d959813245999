//! A ROS 1 node for the tests in `tests/ros1`, which prints its events as lines of JSON.
//!
//! ```text
//! ros1_probe publish TOPIC COUNT RATE [latched] [queue=N]   std_msgs/String, numbered; COUNT 0: no end
//! ros1_probe images TOPIC COUNT RATE [queue=N]              640x480 images to the first subscriber
//! ros1_probe subscribe TOPIC TYPE MD5 COUNT [slow=MS] [queue=N] [max=BYTES]
//! ros1_probe serve SERVICE                                  std_srvs/SetBool; false is refused
//! ros1_probe call SERVICE TYPE MD5 HEX [more=N]              once, and N times over one connection
//! ros1_probe get|has|delete|search|watch KEY, set KEY VALUE, nest KEY, names
//! ros1_probe hold TOPIC                                     publishes, subscribes and serves until killed
//! ```

use std::collections::BTreeMap;
use std::process::ExitCode;
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use opendr_engine::{Error, Result};
use opendr_ros1::{
    Arguments, Node, NodeOptions, ParameterValue, PublisherOptions, ReceivedMessage, ServiceType,
    SubscriberOptions, TopicType,
};

const TEXT: [&str; 3] = ["std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n"];
const IMAGE: [&str; 2] = ["sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743"];
const SET_BOOL: [&str; 2] = ["std_srvs/SetBool", "09fb03525b03e7ea1fd3992bafd87e16"];

fn main() -> ExitCode {
    let arguments = Arguments::new(std::env::args().skip(1));
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say("error", &error.to_string());
            ExitCode::FAILURE
        }
    }
}

fn say(what: &str, text: &str) {
    println!("{{\"{what}\": {}}}", json(text));
}

fn json(text: &str) -> String {
    let letter = |letter: char| match letter {
        '"' | '\\' => format!("\\{letter}"),
        '\0'..'\x20' => format!("\\u{:04x}", u32::from(letter)),
        _ => letter.to_string(),
    };
    format!("\"{}\"", text.chars().map(letter).collect::<String>())
}

/// Returns N of `name=N` among the words.
fn option(words: &[&str], name: &str, otherwise: u64) -> u64 {
    let found = words.iter().find_map(|word| word.strip_prefix(name)?.strip_prefix('=')?.parse().ok());
    found.unwrap_or(otherwise)
}

fn run(arguments: &Arguments) -> Result<()> {
    let words: Vec<&str> = arguments.rest.iter().map(String::as_str).collect();
    let mut options = NodeOptions::new("probe").with_arguments(arguments);
    options.wait_for_master = Duration::from_secs(10);
    options.max_message_bytes = option(&words, "max", 1 << 30) as usize;
    let options = options
        .on_error(|error| say("problem", &error.to_string()))
        .on_shutdown(|reason| say("shutdown", reason));
    let node = Node::new(options)?;
    say("node", node.name());
    match words.as_slice() {
        ["publish", topic, count, rate, rest @ ..] => {
            publish(&node, topic, number(count)?, number(rate)?, rest)
        }
        ["images", topic, count, rate, rest @ ..] => {
            images(&node, topic, number(count)?, number(rate)?, rest)
        }
        ["subscribe", topic, name, md5sum, count, rest @ ..] => {
            subscribe(&node, topic, TopicType::new(*name, *md5sum, ""), number(count)? as u64, rest)
        }
        ["serve", service] => {
            let _server = node.serve(service, ServiceType::new(SET_BOOL[0], SET_BOOL[1]), set_bool)?;
            node.wait();
            Ok(())
        }
        ["call", service, name, md5sum, request, rest @ ..] => {
            node.wait_for_service(service, Duration::from_secs(10))?;
            let kind = ServiceType::new(*name, *md5sum);
            let once = node.call(service, kind.clone(), &bytes(request)?)?;
            say("answer", &String::from_utf8_lossy(&once));
            let client = node.client(service, kind)?;
            for _ in 0..option(rest, "more", 0) {
                let answer = client.call(&bytes(request)?)?;
                say("answer", &String::from_utf8_lossy(&answer));
            }
            Ok(())
        }
        ["hold", topic] => hold(&node, topic),
        rest => parameters(&node, rest),
    }
}

fn number(word: &str) -> Result<f64> {
    word.parse().map_err(|_| Error::invalid_param(format!("{word} is no number")))
}

fn bytes(hex: &str) -> Result<Vec<u8>> {
    let pairs = (0..hex.len()).step_by(2).map(|at| u8::from_str_radix(hex.get(at..at + 2).unwrap_or(""), 16));
    pairs.collect::<Result<_, _>>().map_err(|_| Error::invalid_param(format!("{hex} is no hexadecimal")))
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

fn set_bool(request: &[u8]) -> Result<Vec<u8>, String> {
    match request {
        [1] => Ok([&[1], text("switched on").as_slice()].concat()),
        _ => {
            assert_eq!(request, [0], "no ground truth value");
            Err("it stays on".to_owned())
        }
    }
}

fn publisher_options(words: &[&str]) -> PublisherOptions {
    PublisherOptions { latched: words.contains(&"latched"), queue_size: option(words, "queue", 10) as usize }
}

fn publish(node: &Node, topic: &str, count: f64, rate: f64, words: &[&str]) -> Result<()> {
    let publisher =
        node.advertise(topic, TopicType::new(TEXT[0], TEXT[1], TEXT[2]), publisher_options(words))?;
    if words.contains(&"wait") {
        publisher.wait_for_subscribers(1, Duration::from_secs(20));
    }
    let mut sent = 0;
    while (count == 0.0 || f64::from(sent) < count) && !node.is_shut_down() {
        publisher.publish(&text(&format!("{} {sent}", node.name())))?;
        sent += 1;
        sleep(Duration::from_secs_f64(1.0 / rate));
    }
    if words.contains(&"latched") {
        node.wait();
    }
    Ok(())
}

fn images(node: &Node, topic: &str, count: f64, rate: f64, words: &[&str]) -> Result<()> {
    let publisher = node.advertise(
        topic,
        TopicType::new(IMAGE[0], IMAGE[1], "Header header\n"),
        publisher_options(words),
    )?;
    if !publisher.wait_for_subscribers(1, Duration::from_secs(30)) {
        return Err(Error::network("nobody subscribed"));
    }
    sleep(Duration::from_millis(300));
    let started = Instant::now();
    for sequence in 0..count as u32 {
        let due = Duration::from_secs_f64(f64::from(sequence) / rate);
        sleep(due.saturating_sub(started.elapsed()));
        publisher.publish_owned(image(sequence))?;
    }
    sleep(Duration::from_millis(500));
    println!("{{\"published\": {count}, \"dropped\": {}}}", publisher.dropped());
    Ok(())
}

/// Returns an image whose bytes all depend on its sequence number.
fn image(sequence: u32) -> Vec<u8> {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let mut message = Vec::with_capacity(640 * 480 * 3 + 100);
    for word in [sequence, now.as_secs() as u32, now.subsec_nanos()] {
        message.extend(word.to_le_bytes());
    }
    message.extend(text("camera"));
    message.extend([480_u32.to_le_bytes(), 640_u32.to_le_bytes()].concat());
    message.extend(text("bgr8"));
    message.push(0);
    message.extend([1920_u32.to_le_bytes(), (640 * 480 * 3_u32).to_le_bytes()].concat());
    message.resize(message.len() + 640 * 480 * 3, sequence as u8);
    message
}

fn subscribe(node: &Node, topic: &str, kind: TopicType, count: u64, words: &[&str]) -> Result<()> {
    let options = SubscriberOptions { queue_size: option(words, "queue", 1) as usize, ..Default::default() };
    let pause = Duration::from_millis(option(words, "slow", 0));
    let subscription = node.subscribe(topic, kind, options)?;
    let mut taken = 0;
    while count == 0 || taken < count {
        let Some(message) = subscription.recv_timeout(Duration::from_secs(60)) else {
            return Err(Error::network(format!("{taken} of {count} messages came")));
        };
        taken += 1;
        tell(&message, subscription.dropped());
        sleep(pause);
    }
    Ok(())
}

fn tell(message: &ReceivedMessage, dropped: u64) {
    let word = |at| {
        message.bytes.get(at..at + 4).and_then(|four| four.try_into().ok()).map_or(0, u32::from_le_bytes)
    };
    let publisher = &message.publisher;
    if message.bytes.len() > 900_000 {
        let sent = UNIX_EPOCH + Duration::new(word(4).into(), word(8) % 1_000_000_000);
        let late = message.received_at.duration_since(sent).unwrap_or_default().as_micros();
        // Two memory comparisons, since a loop over bytes is too slow in a debug build.
        let pixels =
            message.bytes.len().checked_sub(640 * 480 * 3).map_or(&[][..], |from| &message.bytes[from..]);
        let whole = pixels.first() == Some(&(word(0) as u8)) && pixels[1..] == pixels[..pixels.len() - 1];
        println!(
            "{{\"image\": {}, \"late_us\": {late}, \"whole\": {whole}, \"dropped\": {dropped}}}",
            word(0)
        );
    } else {
        let text = String::from_utf8_lossy(message.bytes.get(4..).unwrap_or_default());
        println!(
            "{{\"text\": {}, \"from\": {}, \"type\": {}, \"latching\": {}, \"dropped\": {dropped}}}",
            json(&text),
            json(&publisher.caller_id),
            json(&publisher.type_name),
            publisher.latching
        );
    }
}

fn hold(node: &Node, topic: &str) -> Result<()> {
    let kind = || TopicType::new(TEXT[0], TEXT[1], TEXT[2]);
    let publisher = node.advertise(topic, kind(), PublisherOptions::default())?;
    let heard =
        node.subscribe("heard", kind(), SubscriberOptions { queue_size: 100, ..Default::default() })?;
    let _listener = heard.on_message(|message| tell(&message, 0))?;
    let _server = node.serve("~switch", ServiceType::new(SET_BOOL[0], SET_BOOL[1]), set_bool)?;
    say("ready", node.uri());
    while !node.wait_timeout(Duration::from_millis(50)) {
        publisher.publish(&text("held")).ok();
    }
    Ok(())
}

fn text_of(value: &ParameterValue) -> String {
    format!("{value:?}").replace('"', "'")
}

fn parameters(node: &Node, words: &[&str]) -> Result<()> {
    match words {
        ["get", key] => say("value", &text_of(&node.parameter(key)?)),
        ["has", key] => println!("{{\"has\": {}}}", node.has_parameter(key)?),
        ["delete", key] => node.delete_parameter(key)?,
        ["search", key] => say("found", &node.search_parameter(key)?.unwrap_or_default()),
        ["names"] => say("names", &node.parameter_names()?.join(" ")),
        ["set", key, value] => node.set_parameter(key, *value)?,
        ["nest", key] => {
            let inner = [("gain".to_owned(), 0.5.into()), ("on".to_owned(), true.into())];
            let list = vec![1.into(), "a <b> & c\n\u{e9}".into(), ParameterValue::List(vec![2.5.into()])];
            let blob = ParameterValue::Base64(vec![0, 1, 255]);
            let outer: [(String, ParameterValue); 3] = [
                ("inner".to_owned(), ParameterValue::Struct(BTreeMap::from(inner))),
                ("list".to_owned(), list.into()),
                ("blob".to_owned(), blob),
            ];
            node.set_parameter(key, BTreeMap::from(outer))?;
        }
        ["watch", key] => {
            let (_watch, now) = node.watch_parameter(key, |key, value| {
                println!(
                    "{{\"changed\": {key:?}, \"value\": \"{}\"}}",
                    format!("{value:?}").replace('"', "'")
                );
            })?;
            say("value", &text_of(&now));
            node.wait();
        }
        _ => {
            return Err(Error::invalid_param(format!(
                "{words:?} is no command; the head of the example has all"
            )));
        }
    }
    Ok(())
}
